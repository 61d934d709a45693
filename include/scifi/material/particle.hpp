// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>
#include <optional>
#include <string_view>

namespace scifi {

/// A particle hypothesis: plain data, so that a user can add any other charged particle.
/// Mass in MeV, charge in e, PDG Monte Carlo number; the name must outlive the particle (a literal does).
struct particle {
  double mass;
  int charge;
  int pdg_id;
  std::string_view name;
};

// Masses: PDG 2024, Review of Particle Physics, Phys. Rev. D 110 (2024) 030001, summary tables. Numbers: the same, section 45.
inline constexpr particle electron{0.51099895, -1, 11, "e-"};
inline constexpr particle positron{0.51099895, +1, -11, "e+"};
inline constexpr particle muon_minus{105.6583755, -1, 13, "mu-"};
inline constexpr particle muon_plus{105.6583755, +1, -13, "mu+"};
inline constexpr particle pion_plus{139.57039, +1, 211, "pi+"};
inline constexpr particle pion_minus{139.57039, -1, -211, "pi-"};
inline constexpr particle proton{938.27208816, +1, 2212, "p"};
inline constexpr particle antiproton{938.27208816, -1, -2212, "pbar"};

namespace detail {

inline constexpr std::array known_particles{electron, positron, muon_minus, muon_plus, pion_plus, pion_minus, proton, antiproton};

struct particle_alias {
  std::string_view alias;
  int pdg_id;
};

inline constexpr std::array particle_aliases{
    particle_alias{"e", 11},        particle_alias{"electron", 11}, particle_alias{"positron", -11},     particle_alias{"mu", 13},
    particle_alias{"muon", 13},     particle_alias{"pi", 211},      particle_alias{"pion", 211},         particle_alias{"p+", 2212},
    particle_alias{"proton", 2212}, particle_alias{"p-", -2212},    particle_alias{"antiproton", -2212},
};

}  // namespace detail

/// The known particle with this PDG number (13 = mu-, -13 = mu+, 211 = pi+, 11 = e-, 2212 = p), or nothing.
[[nodiscard]] constexpr std::optional<particle> particle_from_pdg(int pdg_id) {
  for (const particle& known : detail::known_particles) {
    if (known.pdg_id == pdg_id) return known;
  }
  return std::nullopt;
}

/// The known particle of this name ("mu-", "mu+", "pi+", "pi-", "e-", "e+", "p", "pbar", or in words), or nothing.
/// A name without a charge means the one with the positive PDG number: "mu" = mu-, "e" = e-, "pi" = pi+.
[[nodiscard]] constexpr std::optional<particle> particle_from_name(std::string_view name) {
  for (const particle& known : detail::known_particles) {
    if (known.name == name) return known;
  }
  for (const detail::particle_alias& other : detail::particle_aliases) {
    if (other.alias == name) return particle_from_pdg(other.pdg_id);
  }
  return std::nullopt;
}

/// The antiparticle: same mass, opposite charge and PDG number; named "antiparticle" when it is not one of the known ones.
[[nodiscard]] constexpr particle charge_conjugate(const particle& original) {
  const std::optional<particle> known = particle_from_pdg(-original.pdg_id);
  return {original.mass, -original.charge, -original.pdg_id, known ? known->name : std::string_view("antiparticle")};
}

}  // namespace scifi
