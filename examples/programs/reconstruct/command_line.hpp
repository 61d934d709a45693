// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <initializer_list>
#include <stdexcept>
#include <string>
#include <system_error>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <scifi/chain/reconstruction.hpp>
#include <scifi/geometry/mice.hpp>
#include <scifi/io/any_geometry.hpp>
#include <scifi/material/particle.hpp>

#include "conditions/stored_conditions.hpp"
#include "field/chosen_field.hpp"

/// A particle by its name; a name without a sign means the positive one, for the beam of MICE is.
[[nodiscard]] inline scifi::particle hypothesis_named(const std::string& name) {
  const auto found = scifi::particle_from_name(name);
  if (!found) throw std::invalid_argument("--particle: '" + name + "' is not known; try mu, pi, e or p");
  const bool without_sign = name == "mu" || name == "muon" || name == "pi" || name == "pion" || name == "e";
  return without_sign && found->charge < 0 ? scifi::charge_conjugate(*found) : *found;
}

/// True when both names mean the same file, which need not exist.
[[nodiscard]] inline bool same_file(const std::filesystem::path& a, const std::filesystem::path& b) {
  namespace fs = std::filesystem;
  std::error_code none;
  return fs::weakly_canonical(a, none) == fs::weakly_canonical(b, none) || fs::equivalent(a, b, none);
}

/// What a program that reconstructs is told: the digits, and how tracks are made of them.
struct reconstruction_input {
  std::string digits, geometry, particle = "mu";
  stored_conditions stored;
  chosen_field field;
  double min_npe = 2.0, momentum = 200.0;
  int threads = 0;

  void offer(CLI::App& app) {
    app.add_option("DIGITS", digits, "digits: CSV with the columns event, tracker, station, plane, channel, npe, or MICE JSON (.json); may be gzip")->required();
    app.add_option("--geometry", geometry, "geometry in JSON (.json) or MiceModules (.dat); the MICE trackers unless given");
    stored.offer(app);
    field.offer(app);
    app.add_option("--particle", particle, "particle whose mass the fit assumes: mu, pi, e, p")->capture_default_str();
    app.add_option("--min-npe", min_npe, "least light of a digit, photo-electrons")->capture_default_str();
    app.add_option("--momentum", momentum, "momentum along z assumed for straight tracks, MeV/c")->capture_default_str();
    app.add_option("--threads", threads, "number of threads; 0: all cores. The output does not depend on it")->check(CLI::Range(0, 1024))->capture_default_str();
  }

  /// Reads the geometry, from a store of conditions too, prints its notes and gets `field` ready. `outputs` are the names of files to be written; empty names are
  /// none. Throws std::invalid_argument or scifi::input_error where an option makes no sense, or a file to be written is read or named twice.
  [[nodiscard]] scifi::any_geometry prepare(std::initializer_list<std::string> outputs) {
    stored.fill_in(geometry, scifi::condition_kind::geometry);
    check(outputs);
    scifi::any_geometry out;
    if (geometry.empty()) out.detector = scifi::mice::trackers();
    else out = scifi::read_any_geometry(geometry);
    for (const std::string& note : out.notes) fmt::print(stderr, "note: {}\n", note);
    field.resolve(out.detector, &out);
    return out;
  }
  /// What the geometry is, for people.
  [[nodiscard]] std::string geometry_name() const { return geometry.empty() ? "MICE trackers as surveyed" : stored.origin(geometry); }

  /// What a chain takes besides the detector and the field. Throws std::invalid_argument.
  [[nodiscard]] scifi::reconstruction_options choice(const scifi::any_geometry& from) const {
    return {.hypothesis = hypothesis_named(particle), .min_npe = min_npe, .line_momentum = momentum, .fibre = from.fibre};
  }

 private:
  void check(std::initializer_list<std::string> outputs) const {
    if (!(std::isfinite(min_npe) && min_npe >= 0.0)) throw std::invalid_argument("--min-npe: not a finite number from 0 on");
    if (!(std::isfinite(momentum) && momentum > 0.0)) throw std::invalid_argument("--momentum: not a finite number above 0");
    for (const std::string* out = outputs.begin(); out != outputs.end(); ++out) {
      if (out->empty()) continue;
      for (const std::string& in : {digits, geometry, stored.store(), field.file()})
        if (!in.empty() && same_file(in, *out)) throw std::invalid_argument(*out + ": would overwrite what is read");
      for (const std::string* other = out + 1; other != outputs.end(); ++other)
        if (!other->empty() && same_file(*out, *other)) throw std::invalid_argument(*out + " and " + *other + ": the same file, for two outputs");
    }
  }
};
