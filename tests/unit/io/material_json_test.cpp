// SPDX-License-Identifier: MPL-2.0
#include <scifi/io/material_json.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <scifi/material/bethe.hpp>
#include <scifi/material/particle.hpp>

#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

namespace {

using scifi::input_error;
using scifi::material;
namespace materials = scifi::materials;
namespace units = scifi::units;
using scifi::test::message_of;

material from_text(const char* text, const char* name) {
  const auto document = nlohmann::json::parse(text);
  return scifi::material_from_json(scifi::json_field(document, "f.json"), name);
}

double loss(const material& m, double p) { return scifi::mean_energy_loss_rate(p, scifi::muon_plus, m).value; }

}  // namespace

TEST_CASE("Z over A follows from the formula", "[io]") {
  // PDG 2024, Atomic and Nuclear Properties of Materials; given there to five digits, for lithium of 6.941 and hydrogen of 1.00794.
  CHECK(scifi::z_over_a_of_formula("C8H8").value() == Approx(0.53768).epsilon(2e-5));
  CHECK(scifi::z_over_a_of_formula("C10H8O4").value() == Approx(0.52037).epsilon(2e-5));
  CHECK(scifi::z_over_a_of_formula("He").value() == Approx(0.49967).epsilon(2e-5));
  CHECK(scifi::z_over_a_of_formula("H2").value() == Approx(0.99212).epsilon(1e-4));
  CHECK(scifi::z_over_a_of_formula("Al").value() == Approx(0.48181).epsilon(2e-5));
  CHECK(scifi::z_over_a_of_formula("LiH").value() == Approx(0.50321).epsilon(2e-4));
  CHECK(scifi::z_over_a_of_formula("SiO2").value() == Approx(0.49930).epsilon(2e-5));
}

TEST_CASE("a formula that is not understood has no Z over A", "[io]") {
  for (const char* formula : {"", "Qq", "C8(H8)", "c8h8", "8", "C99999999999", "C 8", "C0"}) CHECK_FALSE(scifi::z_over_a_of_formula(formula).has_value());
}

TEST_CASE("a known name fills in what the file leaves out", "[io]") {
  const material m = from_text("{}", "aluminium");
  CHECK(m.name == "aluminium");
  CHECK(m.density == materials::aluminium.density);
  CHECK(m.radiation_length == materials::aluminium.radiation_length);
  CHECK(m.density_effect.c == materials::aluminium.density_effect.c);
}

TEST_CASE("a known name at another density: the density effect follows the plasma energy", "[io]") {
  const material m = from_text(R"({"density_g_cm3": 3.326e-4})", "helium");
  CHECK(m.radiation_length == Approx(0.5 * materials::helium.radiation_length));
  // Delta depends on beta gamma times the plasma energy alone, which grows by sqrt(2): compare at equal products, above x0.
  for (const double beta_gamma : {300.0, 1000.0, 1e5}) {
    const double twice_as_dense = scifi::density_effect(beta_gamma / std::sqrt(2.0), m.density_effect).value;
    CHECK(twice_as_dense == Approx(scifi::density_effect(beta_gamma, materials::helium.density_effect).value).epsilon(1e-12));
  }
}

TEST_CASE("another name needs all numbers and gets an estimated density effect", "[io]") {
  const char* text = R"({"formula": "SiO2", "density_g_cm3": 2.2, "radiation_length": 122.9, "mean_excitation_energy_eV": 139.2})";
  const material m = from_text(text, "quartz");
  CHECK(m.z_over_a == Approx(0.49930).epsilon(2e-5));
  CHECK(m.mean_excitation_energy == Approx(139.2e-6));
  // PDG 2024: C-bar of fused quartz is 4.0560 (it follows from density, I and Z/A), minimum ionisation 1.699 MeV cm2/g.
  CHECK(m.density_effect.c == Approx(4.0560).margin(1e-3));
  double least = 1e9;
  for (double p = 200.0; p < 600.0; p += 5.0) least = std::min(least, loss(m, p) * units::cm / m.density);
  CHECK(least == Approx(1.699).epsilon(0.01));
}

TEST_CASE("the estimated density effect reproduces the stopping power of measured media", "[io]") {
  for (const material& m : {materials::polystyrene, materials::mylar, materials::helium, materials::aluminium, materials::air}) {
    material estimated = m;
    estimated.density_effect = scifi::sternheimer_peierls(m.mean_excitation_energy, m.density, m.z_over_a);
    for (const double p : {50.0, 100.0, 200.0, 500.0, 2000.0, 1e4, 1e5}) {
      INFO(m.name << " at " << p << " MeV/c");
      CHECK(loss(estimated, p) == Approx(loss(m, p)).epsilon(0.02));
    }
  }
}

TEST_CASE("parameters given in the file are taken as they are, and null is an infinite radiation length", "[io]") {
  const material m = from_text(R"({"z_over_a": 0.5, "density_g_cm3": 0.0, "radiation_length": null, "mean_excitation_energy_eV": 10,
    "density_effect": {"a": 1, "m": 2, "x0": 3, "x1": 4, "c": 5, "delta0": 6}})",
                               "nothing");
  CHECK(std::isinf(m.radiation_length));
  CHECK(m.density_effect.a == 1.0);
  CHECK(m.density_effect.delta0 == 6.0);
  CHECK(from_text("{}", "vacuum").density == 0.0);
}

TEST_CASE("where the density effect of an unmeasured medium sets in: the published table", "[io]") {
  // Sternheimer and Peierls, Phys. Rev. B 3 (1971) 3681, as in Sternheimer, Berger and Seltzer, ADNDT 30 (1984) 261, equations 9 to 11.
  struct row {
    double density;                 // g/cm3
    double mean_excitation_energy;  // eV, of solids; of gases it follows from c
    double c, x0, x1;
  };
  const row table[] = {
      {0.001, 0.0, 9.0, 1.6, 4.0},  {0.001, 0.0, 10.2, 1.7, 4.0}, {0.001, 0.0, 10.7, 1.8, 4.0}, {0.001, 0.0, 11.2, 1.9, 4.0},
      {0.001, 0.0, 12.0, 2.0, 4.0}, {0.001, 0.0, 13.0, 2.0, 5.0}, {0.001, 0.0, 14.0, 2.064, 5.0},
      {0.0, 70.0, 3.0, 0.2, 2.0},   {0.0, 70.0, 5.0, 0.63, 2.0},  {0.0, 200.0, 5.0, 0.2, 3.0},  {0.0, 200.0, 6.0, 0.456, 3.0},
  };
  constexpr double z_over_a = 0.5;
  for (const row& r : table) {
    // c = 2 ln(I / plasma energy) + 1, plasma energy = 28.816 eV sqrt(density Z/A)
    const double ratio = std::exp(0.5 * (r.c - 1.0));
    const double density = r.density > 0.0 ? r.density : std::pow(r.mean_excitation_energy / (28.816 * ratio), 2) / z_over_a;
    const double excitation = 28.816 * std::sqrt(density * z_over_a) * ratio * units::eV;
    const auto got = scifi::sternheimer_peierls(excitation, density, z_over_a);
    CAPTURE(r.c, density);
    CHECK(got.c == Approx(r.c).epsilon(1e-12));
    CHECK(got.x0 == Approx(r.x0).epsilon(1e-12));
    CHECK(got.x1 == r.x1);
    // At x0 the effect begins from zero.
    CHECK(2.0 * std::numbers::ln10 * got.x0 - got.c + got.a * std::pow(got.x1 - got.x0, got.m) == Approx(0.0).margin(1e-12 * r.c));
  }
}

TEST_CASE("a wrong material is refused with its field", "[io]") {
  struct row {
    const char* text;
    const char* message;
  };
  const row table[] = {
      {R"({})", "f.json: density_g_cm3: is missing"},
      {R"({"density_g_cm3": -1})", "f.json: density_g_cm3: is negative"},
      {R"({"density_g_cm3": "dense"})", "f.json: density_g_cm3: '\"dense\"' is not a number"},
      {R"({"density_g_cm3": 1})", "f.json: radiation_length: is missing"},
      {R"({"density_g_cm3": 1, "radiation_length": 0})", "f.json: radiation_length: 0 is not above zero"},
      {R"({"density_g_cm3": 1, "radiation_length": 9})", "f.json: mean_excitation_energy_eV: is missing"},
      {R"({"density_g_cm3": 1, "radiation_length": 9, "mean_excitation_energy_eV": 70})", "f.json: formula: is missing"},
      {R"({"density_g_cm3": 1, "radiation_length": 9, "mean_excitation_energy_eV": 70, "formula": "Zz3"})",
       "f.json: formula: 'Zz3' is not understood; give z_over_a instead"},
      {R"({"density_g_cm3": 1, "radiation_length": 9, "mean_excitation_energy_eV": 70, "z_over_a": 2})", "f.json: z_over_a: is outside 0 .. 1"},
      {R"({"density_g_cm3": 1, "radiation_length": 9, "mean_excitation_energy_eV": 70, "z_over_a": 0.5, "density_effect": {"a": 1}})",
       "f.json: density_effect.m: is missing"},
  };
  for (const row& r : table) CHECK(message_of<input_error>([&] { (void)from_text(r.text, "other"); }) == r.message);
}
