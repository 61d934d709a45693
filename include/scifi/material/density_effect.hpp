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

/// The same with the derivative in ln(beta gamma).
template <scalar Scalar>
struct density_effect_by_logarithm {
  Scalar value;
  Scalar d_value_d_log;
};

/// delta(x), x = log10(beta gamma), PDG 2024 eq. 34.7 (Sternheimer's parametrisation), for beta gamma > 0:
/// 2 ln10 x - C above x1; 2 ln10 x - C + a (x1 - x)^m between x0 and x1; delta0 10^(2(x - x0)) below x0 (zero in insulators).
/// The rounding of the tabulated parameters leaves steps below 3e-4 at x0.
template <scalar Scalar>
[[nodiscard]] density_effect_by_logarithm<Scalar> density_effect_at_log(const Scalar& log_beta_gamma, const material::sternheimer& s) {
  using std::exp;
  using std::log;
  constexpr double ln10 = std::numbers::ln10;
  const Scalar x = log_beta_gamma * Scalar(1.0 / ln10);
  const auto below = x < Scalar(s.x0);
  const auto between = x < Scalar(s.x1);

  const Scalar line = log_beta_gamma * Scalar(2.0) - Scalar(s.c);
  const Scalar distance = select(between, Scalar(Scalar(s.x1) - x), Scalar(1.0));
  Scalar power(0.0);  // a (x1 - x)^(m - 1)
  if (any_of(between) && !all_of(below)) power = exp(log(distance) * Scalar(s.m - 1.0)) * Scalar(s.a);
  const Scalar curved = line + power * distance;
  Scalar conducting(0.0);
  if (s.delta0 != 0.0 && any_of(below)) conducting = exp((x - Scalar(s.x0)) * Scalar(2.0 * ln10)) * Scalar(s.delta0);

  const Scalar slope_curved = Scalar(2.0) - power * Scalar(s.m / ln10);
  const Scalar slope_conducting = conducting * Scalar(2.0);
  return {select(below, conducting, select(between, curved, line)), select(below, slope_conducting, select(between, slope_curved, Scalar(2.0)))};
}

/// The same at beta gamma, with the derivative in it.
template <scalar Scalar>
[[nodiscard]] density_effect_correction<Scalar> density_effect(const Scalar& beta_gamma, const material::sternheimer& s) {
  using std::log;
  const density_effect_by_logarithm<Scalar> delta = density_effect_at_log(Scalar(log(beta_gamma)), s);
  return {delta.value, Scalar(delta.d_value_d_log / beta_gamma)};
}

}  // namespace scifi
