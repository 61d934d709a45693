// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <system_error>

#include <scifi/material/particle.hpp>

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
