// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <scifi/io/particle_reader.hpp>
#include <scifi/particle_to_hit/gaussian_beam.hpp>
#include <scifi/particle_to_hit/gun.hpp>

namespace scifi::simulate {

/// The steps of an event that draw random numbers, each from a stream of its own.
enum stage : std::uint32_t { gun, flight, digitisation };

/// Where the particles of the events come from.
struct beam {
  enum class kind { flat, gaussian, file };
  kind from = kind::flat;
  flat_beam flat;
  gaussian_beam gaussian;
  double distance = 30.0;  ///< of the Gaussian beam's plane before the first station that it meets, mm
  std::vector<beam_event> file;
  int tracks_per_event = 1;
  std::function<double(const tracker&)> field;  // mean of Bz in a tracker, (MeV/c)/(e mm)

  /// The number of event i of a run.
  [[nodiscard]] long number(long i) const { return from == kind::file ? file[static_cast<std::size_t>(i)].number : i; }

  /// Appends the particles of event i that fly through `t` to `out`. Those before have the numbers 1 .. before.
  void fill(long i, const tracker& t, std::uint64_t seed, int before, std::vector<moving_particle>& out) const {
    if (from == kind::file) {
      for (const beam_particle& p : file[static_cast<std::size_t>(i)].particles)
        if (p.tracker == t.id) out.push_back(p.start);
      return;
    }
    const station& first = t.beam_direction > 0 ? t.stations.front() : t.stations.back();
    for (int k = 0; k < tracks_per_event; ++k) {
      random_stream random(seed, static_cast<std::uint64_t>(i), stage::gun, static_cast<std::uint32_t>(before + k + 1));
      const double z = first.in_tracker.origin.z() - t.beam_direction * distance;
      out.push_back(from == kind::flat ? flat.shoot(t, random) : gaussian.shoot(z, t.beam_direction, field(t), random));
    }
  }
};

}  // namespace scifi::simulate
