// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <type_traits>

#include <scifi/core/constants.hpp>
#include <scifi/core/inline_vector.hpp>
#include <scifi/core/octave_polynomials.hpp>
#include <scifi/core/scalar.hpp>
#include <scifi/material/density_effect.hpp>
#include <scifi/material/kinematics.hpp>
#include <scifi/material/landau.hpp>
#include <scifi/material/particle.hpp>
#include <scifi/material/slab.hpp>

namespace scifi {

/// Energy lost in a slab, MeV, never negative; a particle followed against its flight gains it.
/// Derivatives in the momentum (MeV per MeV/c) and in path_over_thickness (MeV).
template <scalar Scalar>
struct energy_loss {
  Scalar value;
  Scalar d_value_d_p;
  Scalar d_value_d_path_factor;
};

/// What the loss in a slab about Landau's mode takes of the slab and the charge: all that does not depend on the momentum.
template <class DensityEffect>
struct basic_landau_slab {
  double xi = 0.0;        ///< MeV, for beta = 1 along the normal; zero where nothing is lost
  double log_mode = 0.0;  ///< constants under the logarithms of the mode, gathered, with the offset from it
  double log_mean = 0.0;  ///< the same of the mean
  double mean_over_mode = 1.0;
  DensityEffect density_effect{};
};
using landau_slab = basic_landau_slab<material::sternheimer>;

/// Prepares the mode plus `offset` xi of the loss in `layers` equal layers, the share of one slab.
[[nodiscard]] inline landau_slab landau_slab_of(const particle& hypothesis, const slab& s, double layers, double offset) {
  const double excitation = s.medium.mean_excitation_energy;
  const double xi_per_mm = landau_xi_per_mm(hypothesis, s.medium);
  if (s.thickness <= 0.0 || xi_per_mm <= 0.0) return {};
  const double twice_mass = 2.0 * constants::electron_mass / (excitation * excitation);
  const double log_mode = std::log(twice_mass * xi_per_mm * layer_thickness(s) * layers) + landau::most_probable_offset + offset;
  const double log_mean = std::log(twice_mass);
  return {xi_per_mm * s.thickness, log_mode, log_mean, std::exp(log_mean - log_mode), s.medium.density_effect};
}

/// Sum over slabs of the mode plus offset, each between zero and the slab's mean loss.
///
/// Both are xi times a bracket that begins with ln(2 m_e beta^2 gamma^2 / I) - delta: Landau's goes on with ln(xi_total / I) + 0.200 - beta^2 (PDG 2024 eq. 34.12),
/// twice Bethe's with ln(T_max / I) - 2 beta^2 (eq. 34.5).
template <scalar Scalar, class Slabs>
[[nodiscard, gnu::always_inline]] inline energy_loss<Scalar> loss_in_landau_slabs(const crossing_particle<Scalar>& c, const particle& hypothesis, const Slabs& slabs) {
  using std::log;
  const ionisation_kinematics<Scalar>& k = c.kinematics;
  const Scalar zero(0.0);
  const Scalar d_log_xi = Scalar(-2.0) * k.per_beta_gamma * k.per_gamma_squared;
  const Scalar d_beta_squared = -k.beta_gamma * k.beta_gamma * d_log_xi * k.per_gamma_squared;
  const Scalar d_log_u2 = Scalar(2.0) * k.per_beta_gamma - d_beta_squared;
  const Scalar log_beta_gamma = log(k.beta_gamma);
  const Scalar log_u2 = Scalar(2.0) * log_beta_gamma - k.beta_squared;
  const Scalar of_mode = log_u2 + c.log_path_over_beta_squared;

  energy_loss<Scalar> sum{zero, zero, zero};
  for (const auto& s : slabs) {
    if (s.xi == 0.0) continue;
    const density_effect_by_logarithm<Scalar> delta = density_effect_at_log(log_beta_gamma, s.density_effect);
    Scalar bracket = of_mode + Scalar(s.log_mode);
    Scalar d_bracket = d_log_xi;
    Scalar by_path(1.0);
    // Mean - mode = ln(T_max ratio / (path / beta^2)) - beta^2: far from zero in a thin slab, so that its logarithm is seldom needed.
    if (any_of(k.largest_transfer * Scalar(s.mean_over_mode) < c.path_over_beta_squared * Scalar(std::numbers::e))) {
      const Scalar mean = log_u2 + log(k.largest_transfer) - k.beta_squared + Scalar(s.log_mean);
      const auto thick = mean < bracket;
      bracket = select(thick, mean, bracket);
      d_bracket = select(thick, Scalar(k.d_log_largest_transfer - d_beta_squared), d_bracket);
      by_path = select(thick, zero, by_path);
    }
    bracket -= delta.value;
    d_bracket += d_log_u2 - delta.d_value_d_log * k.per_beta_gamma;
    const Scalar xi_normal = Scalar(s.xi) * k.per_beta_squared;
    const Scalar xi = xi_normal * c.path_over_thickness;
    const auto thin = bracket < zero;
    sum.value += select(thin, zero, Scalar(xi * bracket));
    sum.d_value_d_p += select(thin, zero, Scalar(xi * (d_log_xi * bracket + d_bracket) * Scalar(1.0 / hypothesis.mass)));
    sum.d_value_d_path_factor += select(thin, zero, Scalar(xi_normal * (bracket + by_path)));
  }
  return sum;
}

/// The loss in a stack of slabs, prepared for any momentum.
///
/// For a single particle of double precision the part of the sum of xi times bracket that depends on the momentum alone, all but ln(path/beta^2), is laid
/// down as polynomials in (mass/p)^2 for 0.5 < beta gamma < 16: they give the formula to rounding. The formula is asked elsewhere, and where the loss in a slab is bounded.
template <std::size_t Capacity>
class prepared_landau_loss {
 public:
  prepared_landau_loss(const particle& hypothesis, const inline_vector<landau_slab, Capacity>& slabs) : hypothesis_(hypothesis) {
    for (const landau_slab& s : slabs) {
      if (s.xi == 0.0) continue;
      slabs_.push_back({s.xi, s.log_mode, s.log_mean, s.mean_over_mode, prepared_density_effect(s.density_effect)});
      xi_ += s.xi;
      least_mean_over_mode_ = std::min(least_mean_over_mode_, s.mean_over_mode);
    }
    constexpr int first_octave = -8, octaves = 10;
    if (xi_ > 0.0) brackets_ = octave_polynomials([&slabs](double per_beta_gamma_squared) { return brackets(slabs, per_beta_gamma_squared); }, first_octave, octaves);
  }

  template <scalar Scalar>
  [[nodiscard, gnu::always_inline]] energy_loss<Scalar> loss(const crossing_particle<Scalar>& c) const {
    if constexpr (std::is_same_v<Scalar, double>) {
      const ionisation_kinematics<double>& k = c.kinematics;
      const octave_polynomials::value_and_slope of_momentum = brackets_.at(k.per_beta_gamma_squared);
      if (of_momentum.known && k.largest_transfer * least_mean_over_mode_ >= c.path_over_beta_squared * std::numbers::e) {
        const double d_log_xi = -2.0 * k.per_beta_gamma * k.per_gamma_squared;
        const double sum = of_momentum.value + xi_ * c.log_path_over_beta_squared;
        const double d_sum = xi_ * d_log_xi - 2.0 * k.per_beta_gamma * of_momentum.x_times_slope;
        return {c.path_over_beta_squared * sum, c.path_over_beta_squared * (d_log_xi * sum + d_sum) * (1.0 / hypothesis_.mass), k.per_beta_squared * (sum + xi_)};
      }
      return by_formula(c.p, c.path_over_thickness);
    } else {
      return loss_in_landau_slabs(c, hypothesis_, slabs_);
    }
  }

 private:
  /// Takes two numbers, not the particle that is crossing: what of that is not used need then not be worked out.
  [[nodiscard, gnu::noinline]] energy_loss<double> by_formula(double p, double path_over_thickness) const {
    return loss_in_landau_slabs(crossing_particle_of(p, hypothesis_, path_over_thickness), hypothesis_, slabs_);
  }

  /// Sum of xi times (bracket - ln(path/beta^2)) of the mode; NaN where the bracket along the normal is negative.
  [[nodiscard]] static double brackets(const inline_vector<landau_slab, Capacity>& slabs, double per_beta_gamma_squared) {
    const double log_beta_gamma = -0.5 * std::log(per_beta_gamma_squared);
    const double per_beta_squared = 1.0 + per_beta_gamma_squared;
    double sum = 0.0;
    for (const landau_slab& s : slabs) {
      const double bracket = 2.0 * log_beta_gamma - 1.0 / per_beta_squared + s.log_mode - density_effect_at_log(log_beta_gamma, s.density_effect).value;
      if (s.xi > 0.0 && !(bracket + std::log(per_beta_squared) >= 0.0)) return std::numeric_limits<double>::quiet_NaN();
      sum += s.xi * bracket;
    }
    return sum;
  }

  particle hypothesis_;
  inline_vector<basic_landau_slab<prepared_density_effect>, Capacity> slabs_;
  double xi_ = 0.0;
  double least_mean_over_mode_ = std::numeric_limits<double>::max();
  octave_polynomials brackets_;
};

}  // namespace scifi
