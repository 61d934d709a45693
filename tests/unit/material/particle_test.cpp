// SPDX-License-Identifier: MPL-2.0
#include "support/catch.hpp"

#include <array>

#include <scifi/material/particle.hpp>

using namespace scifi;

TEST_CASE("Particles have the PDG's masses", "[material]") {
  // CODATA 2022 mass ratios, an independent determination: m_mu/m_e = 206.7682827, m_p/m_e = 1836.152673426.
  CHECK(muon_plus.mass / electron.mass == Approx(206.7682827).epsilon(1e-7));
  CHECK(proton.mass / electron.mass == Approx(1836.152673426).epsilon(1e-7));
  CHECK(pion_plus.mass == Approx(139.5704).margin(2e-4));  // PDG 1986 to 2024 agree to this
}

TEST_CASE("A particle is found by its PDG number with the charge that number means", "[material]") {
  CHECK(particle_from_pdg(13)->charge == -1);
  CHECK(particle_from_pdg(-13)->charge == 1);
  CHECK(particle_from_pdg(11)->charge == -1);
  CHECK(particle_from_pdg(-11)->charge == 1);
  CHECK(particle_from_pdg(211)->charge == 1);
  CHECK(particle_from_pdg(-211)->charge == -1);
  CHECK(particle_from_pdg(2212)->charge == 1);
  CHECK(particle_from_pdg(-2212)->charge == -1);
  CHECK_FALSE(particle_from_pdg(0).has_value());
  CHECK_FALSE(particle_from_pdg(22).has_value());
}

TEST_CASE("A particle is found by name, and a bare name means the positive PDG number", "[material]") {
  for (const particle& known : detail::known_particles) CHECK(particle_from_name(known.name)->pdg_id == known.pdg_id);
  CHECK(particle_from_name("mu")->pdg_id == 13);
  CHECK(particle_from_name("pi")->pdg_id == 211);
  CHECK(particle_from_name("e")->pdg_id == 11);
  CHECK(particle_from_name("p")->pdg_id == 2212);
  CHECK(particle_from_name("positron")->charge == 1);
  for (const detail::particle_alias& other : detail::particle_aliases) CHECK(particle_from_name(other.alias).has_value());
  CHECK_FALSE(particle_from_name("tau").has_value());
  CHECK_FALSE(particle_from_name("").has_value());
}

TEST_CASE("Charge conjugation twice gives the particle back", "[material]") {
  for (const particle& known : detail::known_particles) {
    const particle other = charge_conjugate(known);
    CHECK(other.charge == -known.charge);
    CHECK(other.pdg_id == -known.pdg_id);
    CHECK(other.mass == known.mass);
    CHECK(other.name != known.name);
    CHECK(charge_conjugate(other).name == known.name);
  }
  constexpr particle deuteron{1875.613, 1, 1000010020, "d"};
  CHECK(charge_conjugate(deuteron).name == "antiparticle");
  CHECK(charge_conjugate(deuteron).charge == -1);
}
