// SPDX-License-Identifier: MPL-2.0
#include "support/catch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <scifi/core/pack_math.hpp>
#include <scifi/material/density_effect.hpp>
#include <scifi/material/materials.hpp>

#include "dual.hpp"

using namespace scifi;

namespace {

constexpr std::array media{materials::polystyrene,     materials::mylar,           materials::helium, materials::aluminium,
                           materials::liquid_hydrogen, materials::lithium_hydride, materials::air};

}  // namespace

TEST_CASE("The density effect is the published one", "[material]") {
  // Column delta of the muon tables (see tests/reference): beta gamma = p / 105.65839, printed to 1e-4; p is printed to 4 digits,
  // and d delta / d ln p <= 2 ln 10 / ln 10 = 2 gives 2 * 5e-4. PUMAS rounds a and Z/A: 2e-3 in aluminium's conducting branch.
  const auto delta = [](double p, const material& m) { return density_effect(p / 105.65839, m.density_effect).value; };
  for (const auto& [p, value] :
       {std::pair{47.04, 0.0108}, {100.3, 0.0492}, {152.7, 0.1141}, {221.8, 0.1725}, {286.8, 0.2686}, {1101.0, 1.4347}, {10110.0, 4.9717}}) {
    CHECK(delta(p, materials::aluminium) == Approx(value).margin(2e-3));
  }
  for (const auto& [p, value] : {std::pair{152.7, 0.0}, {164.7, 0.0316}, {221.8, 0.2131}, {286.8, 0.4111}, {1101.0, 1.9756}, {10110.0, 5.8416}}) {
    CHECK(delta(p, materials::polystyrene) == Approx(value).margin(2e-3));
  }
  for (const auto& [p, value] : {std::pair{1e4, 0.0}, {20110.0, 0.0761}, {50110.0, 1.2755}}) {
    CHECK(delta(p, materials::helium) == Approx(value).margin(2e-3));
  }
}

TEST_CASE("The three branches meet", "[material]") {
  for (const material& m : media) {
    INFO(m.name);
    const auto& s = m.density_effect;
    for (const double x : {s.x0, s.x1}) {
      const double below = density_effect(std::pow(10.0, x - 1e-9), s).value;
      const double above = density_effect(std::pow(10.0, x + 1e-9), s).value;
      CHECK(std::abs(above - below) < 3e-4);  // a is tabulated to 1e-5 and multiplies (x1 - x0)^m up to 40
    }
  }
}

TEST_CASE("The prepared density effect is that of the formula, for numbers and in lanes", "[material]") {
  for (const material& m : media) {
    INFO(m.name);
    const auto& s = m.density_effect;
    const prepared_density_effect prepared(s);
    double worst = 0.0, worst_of_floats = 0.0;
    for (double x = s.x0 - 0.2; x < s.x1 + 0.2; x += 0.0037) {  // below, curved within the series and beyond, above
      const double log_beta_gamma = x * std::log(10.0);
      const auto expected = density_effect_at_log(log_beta_gamma, s);
      const auto alone = density_effect_at_log(log_beta_gamma, prepared);
      pack<double> several(log_beta_gamma);
      several.set(1, s.x0 * 0.5);  // a neighbour in another branch
      const auto in_lane = density_effect_at_log(several, prepared);
      const auto of_float = density_effect_at_log(pack<float>(static_cast<float>(log_beta_gamma)), prepared);
      const double scale = 2.0 * std::abs(log_beta_gamma) + s.c;  // of the terms that the value is a difference of
      worst = std::max({worst, std::abs(alone.value - expected.value) / scale, std::abs(alone.d_value_d_log - expected.d_value_d_log),
                        std::abs(in_lane.value[0] - expected.value) / scale, std::abs(in_lane.d_value_d_log[0] - expected.d_value_d_log)});
      if (std::abs(x - s.x0) > 1e-5 && std::abs(x - s.x1) > 1e-5)
        worst_of_floats = std::max({worst_of_floats, std::abs(static_cast<double>(of_float.value[0]) - expected.value) / scale});
    }
    // The power in the derivative is below 2 and, where it is not small, exp((m - 1) log d) is good to some 5 roundings, the series to 4: 18 in all.
    CHECK(worst < 4e-15);
    // The value alone, whose terms are of the size it is compared with: 8 roundings of float.
    CHECK(worst_of_floats < 1e-6);
  }
  CHECK(density_effect_at_log(1.0, prepared_density_effect{}).value == density_effect_at_log(1.0, material::sternheimer{}).value);
}

TEST_CASE("Only the conductor has a density effect below x0", "[material]") {
  for (const material& m : media) {
    const double below = density_effect(std::pow(10.0, m.density_effect.x0 - 0.3), m.density_effect).value;
    if (m.name == "aluminium") {
      CHECK(below == Approx(0.12 * std::pow(10.0, -0.6)).epsilon(1e-12));
    } else {
      CHECK(below == 0.0);
    }
  }
}

TEST_CASE("The derivative of the density effect agrees with automatic differentiation in every branch", "[material]") {
  for (const material& m : media) {
    INFO(m.name);
    for (const double beta_gamma : {0.3, 0.9, 1.9, 20.0, 300.0, 1e5}) {
      const auto d = density_effect(test::variable(beta_gamma, 0), m.density_effect);
      CHECK(d.d_value_d_beta_gamma.value() == Approx(d.value.derivatives()(0)).epsilon(1e-12).margin(1e-14));
    }
  }
}
