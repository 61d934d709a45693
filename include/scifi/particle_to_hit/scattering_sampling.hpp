// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>

#include <scifi/core/constants.hpp>
#include <scifi/core/linalg.hpp>
#include <scifi/core/random.hpp>
#include <scifi/core/scalar.hpp>
#include <scifi/material/concepts.hpp>
#include <scifi/material/slab.hpp>
#include <scifi/particle_to_hit/screened_coulomb.hpp>

namespace scifi {

/// How a slab turns a particle: sample(p, particle, slab, path_over_thickness, random) -> the two projected angles (rad), of a plane each.
/// Law: no thickness, no angle; the angles of N slices of a slab, added, are distributed as the slab's. Models: gaussian_scattering, coulomb_scattering.
template <class T>
concept scattering_sampler = requires(const T sampler, double p, const particle hypothesis, const slab s, double path_factor, random_stream random) {
  { sampler.sample(p, hypothesis, s, path_factor, random) } -> std::convertible_to<vector<double, 2>>;
};

/// Gaussian angles of the variance that a scattering policy gives: no tails. `gaussian_scattering<no_scattering>` is a straight flight.
template <scattering_policy Policy = highland_scattering>
struct gaussian_scattering {
  Policy policy{};

  [[nodiscard]] vector<double, 2> sample(double p, const particle& hypothesis, const slab& s, double path_over_thickness, random_stream& random) const {
    const double width = std::sqrt(policy.variance(p, hypothesis, s, path_over_thickness));
    const double first = random.normal();
    return {width * first, width * random.normal()};
  }
};

/// Screened Coulomb scattering with its tail: angles above a limit one by one from Rutherford's law, the many below it as one Gaussian.
///
/// Single scattering as in `screened_coulomb_of`. One in Z + 1 scatters is off an electron, which turns a particle of mass m by
/// m_e / m at most; the nuclei turn it by hbar c / (p R), R = 1.2 fm (2 Z)^(1/3), at most, where they are no longer points.
/// The limit is chi_c of the slab, passed about once per crossing. Valid for 3 < Z < 20 and angles below 0.3 rad.
/// The screening decides the width of the core: Wentzel's, the default, is 3 % narrower in plastic than Moliere's; the tail is the same.
struct coulomb_scattering {
  double nuclear_charge = 6.0;  ///< of the nuclei that scatter most: carbon in plastics
  double screening_factor = screening::wentzel(6.0);

  [[nodiscard]] vector<double, 2> sample(double p, const particle& hypothesis, const slab& s, double path_over_thickness, random_stream& random) const {
    constexpr double hbar_c = 197.3269804;  // MeV fm
    const auto [chi_c2, chi_a2] = screened_coulomb_of(p, hypothesis, radiation_lengths(s) * path_over_thickness, nuclear_charge, screening_factor);
    if (!(chi_c2 > 0.0)) return {0.0, 0.0};
    const double off_electrons = 1.0 / (nuclear_charge + 1.0);
    const double electrons_to2 = square(constants::electron_mass / hypothesis.mass);
    const double nuclei_to = hbar_c / (p * 1.2 * std::cbrt(2.0 * nuclear_charge));

    // Below the limit: half the mean square of the angle in space for each projection.
    const auto mean_square_up_to = [chi_a2 = chi_a2](double theta2) { return std::log1p(theta2 / chi_a2) - theta2 / (theta2 + chi_a2); };
    const double shares = (1.0 - off_electrons) * mean_square_up_to(chi_c2) + off_electrons * mean_square_up_to(std::min(chi_c2, electrons_to2));
    const double width = std::sqrt(0.5 * chi_c2 * shares);
    const double first = random.normal();
    vector<double, 2> angles{width * first, width * random.normal()};

    // Above it screening no longer matters: the number beyond theta is chi_c^2 / theta^2.
    const double smallest_share = chi_c2 / square(nuclei_to);
    const int hard = smallest_share < 1.0 ? random.poisson(1.0 - smallest_share) : 0;
    for (int i = 0; i < hard; ++i) {
      const double theta2 = chi_c2 / random.uniform(smallest_share, 1.0);
      const double azimuth = random.uniform(0.0, 2.0 * constants::pi);
      if (random.uniform() < off_electrons && theta2 > electrons_to2) continue;
      angles += std::sqrt(theta2) * vector<double, 2>(std::cos(azimuth), std::sin(azimuth));
    }
    return angles;
  }
};

/// Turns a direction by two projected angles (rad), each about its own axis at right angles to it; its length stays.
[[nodiscard]] inline vector<double, 3> turned_by(const vector<double, 3>& momentum, const vector<double, 2>& angles) {
  const double angle = angles.norm();
  if (angle == 0.0) return momentum;
  const double p = momentum.norm();
  const vector<double, 3> forward = momentum / p;
  // Any axis not along the momentum will do: the angles are isotropic.
  const vector<double, 3> helper = std::abs(forward.x()) < 0.9 ? vector<double, 3>::UnitX() : vector<double, 3>::UnitY();
  const vector<double, 3> first = (helper - helper.dot(forward) * forward).normalized();
  const vector<double, 3> second{forward.y() * first.z() - forward.z() * first.y(), forward.z() * first.x() - forward.x() * first.z(),
                                 forward.x() * first.y() - forward.y() * first.x()};
  const vector<double, 3> sideways = (angles.x() * first + angles.y() * second) / angle;
  return p * (std::cos(angle) * forward + std::sin(angle) * sideways);
}

}  // namespace scifi
