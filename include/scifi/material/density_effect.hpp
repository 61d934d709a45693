// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>
#include <numbers>

#include <scifi/core/scalar.hpp>
#include <scifi/material/material.hpp>

namespace scifi {

/// The density-effect correction delta (dimensionless) and its derivative in beta gamma.
template <scalar Scalar>
struct density_effect_correction {
  Scalar value;
  Scalar d_value_d_beta_gamma;
};

/// delta(x), x = log10(beta gamma), PDG 2024 eq. 34.7 (Sternheimer's parametrisation), for beta gamma > 0:
/// 2 ln10 x - C above x1; 2 ln10 x - C + a (x1 - x)^m between x0 and x1; delta0 10^(2(x - x0)) below x0 (zero in insulators).
/// The rounding of the tabulated parameters leaves steps below 3e-4 at x0.
template <scalar Scalar>
[[nodiscard]] density_effect_correction<Scalar> density_effect(const Scalar& beta_gamma, const Scalar& log_beta_gamma, const material::sternheimer& s) {
  using std::exp;
  using std::log;
  constexpr double ln10 = std::numbers::ln10;
  const Scalar x = log_beta_gamma * Scalar(1.0 / ln10);
  const auto below = x < Scalar(s.x0);
  const auto between = x < Scalar(s.x1);

  const Scalar distance = select(between, Scalar(Scalar(s.x1) - x), Scalar(1.0));
  const Scalar power = exp(log(distance) * Scalar(s.m - 1.0)) * Scalar(s.a);  // a (x1 - x)^(m - 1)
  const Scalar line = log_beta_gamma * Scalar(2.0) - Scalar(s.c);
  const Scalar curved = line + power * distance;
  const Scalar conducting = s.delta0 == 0.0 ? Scalar(0.0) : Scalar(exp((x - Scalar(s.x0)) * Scalar(2.0 * ln10)) * Scalar(s.delta0));

  const Scalar slope_curved = Scalar(2.0 * ln10) - power * Scalar(s.m);
  const Scalar slope_conducting = conducting * Scalar(2.0 * ln10);
  const Scalar value = select(below, conducting, select(between, curved, line));
  const Scalar d_value_d_x = select(below, slope_conducting, select(between, slope_curved, Scalar(2.0 * ln10)));
  const Scalar d_value_d_beta_gamma = d_value_d_x / (beta_gamma * Scalar(ln10));
  return {value, d_value_d_beta_gamma};
}

/// The same with the logarithm taken here.
template <scalar Scalar>
[[nodiscard]] density_effect_correction<Scalar> density_effect(const Scalar& beta_gamma, const material::sternheimer& s) {
  using std::log;
  return density_effect(beta_gamma, Scalar(log(beta_gamma)), s);
}

}  // namespace scifi
