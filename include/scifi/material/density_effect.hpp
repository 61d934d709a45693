// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include <scifi/core/lane.hpp>
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

/// Sternheimer's parameters with the power in their curved part prepared: a (x1 - x)^(m - 1) = a d0^(m - 1) (1 - v)^(m - 1), v = 1 - (x1 - x)/d0.
///
/// With d0 = 4/5 (x1 - x0) and |v| <= 1/4, in the first two fifths from x0 to x1, a binomial series (DLMF 4.6.7), cut where the next term is below the rounding
/// error: lanes then wait for no logarithm and no exponential. Beyond, and for a curved part of no length, the formula is asked.
struct prepared_density_effect : material::sternheimer {
  static constexpr std::size_t terms = 20, terms_of_float = 8;
  double per_d0 = 0.0;
  std::array<double, terms> series{};

  prepared_density_effect() = default;
  explicit prepared_density_effect(const material::sternheimer& of) : material::sternheimer(of) {
    const double d0 = 0.8 * (of.x1 - of.x0);
    if (!(d0 > 0.0)) return;
    per_d0 = 1.0 / d0;
    series[0] = of.a * std::pow(d0, of.m - 1.0);
    for (std::size_t k = 1; k < terms; ++k) series[k] = series[k - 1] * (static_cast<double>(k) - of.m) / static_cast<double>(k);
  }
};

namespace detail {

/// a d^(m - 1), d = x1 - x, in the lanes where it is asked for.
template <scalar Scalar, class Mask>
[[nodiscard]] Scalar curved_power(const material::sternheimer& s, const Scalar& distance, const Mask&) {
  using std::exp;
  using std::log;
  return exp(log(distance) * Scalar(s.m - 1.0)) * Scalar(s.a);
}
template <scalar Scalar, class Mask>
[[nodiscard, gnu::always_inline]] inline Scalar curved_power(const prepared_density_effect& s, const Scalar& distance, const Mask& asked) {
  const Scalar v = Scalar(1.0) - distance * Scalar(s.per_d0);
  if (any_of(asked && v > Scalar(0.25))) return curved_power(static_cast<const material::sternheimer&>(s), distance, asked);
  constexpr std::size_t terms = sizeof(lane_type<Scalar>) < sizeof(double) ? prepared_density_effect::terms_of_float : prepared_density_effect::terms;
  const Scalar v2 = v * v;
  const Scalar v4 = v2 * v2;
  Scalar part[4];  // every fourth term, so that they do not wait for each other
  for (std::size_t i = 0; i < 4; ++i) {
    part[i] = Scalar(s.series[terms - 4 + i]);
    for (std::size_t k = terms - 4; k > 0; k -= 4) part[i] = part[i] * v4 + Scalar(s.series[k - 4 + i]);
  }
  return (part[0] + v * part[1]) + v2 * (part[2] + v * part[3]);
}

}  // namespace detail

/// delta(x), x = log10(beta gamma), PDG 2024 eq. 34.7 (Sternheimer's parametrisation), for beta gamma > 0:
/// 2 ln10 x - C above x1; 2 ln10 x - C + a (x1 - x)^m between x0 and x1; delta0 10^(2(x - x0)) below x0 (zero in insulators).
/// The rounding of the tabulated parameters leaves steps below 3e-4 at x0.
/// The parameters are Sternheimer's, or prepared.
template <scalar Scalar, class Parameters>
[[nodiscard, gnu::always_inline]] inline density_effect_by_logarithm<Scalar> density_effect_at_log(const Scalar& log_beta_gamma, const Parameters& s) {
  using std::exp;
  constexpr double ln10 = std::numbers::ln10;
  const Scalar x = log_beta_gamma * Scalar(1.0 / ln10);
  const auto below = x < Scalar(s.x0);
  const auto between = x < Scalar(s.x1);

  const Scalar line = log_beta_gamma * Scalar(2.0) - Scalar(s.c);
  const Scalar distance = select(between, Scalar(Scalar(s.x1) - x), Scalar(1.0));
  Scalar power(0.0);  // a (x1 - x)^(m - 1)
  if (any_of(between) && !all_of(below)) power = detail::curved_power(s, distance, between && !below);
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
