// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>

#include <scifi/core/inline_vector.hpp>
#include <scifi/core/random.hpp>
#include <scifi/material/bethe.hpp>
#include <scifi/material/concepts.hpp>
#include <scifi/material/kinematics.hpp>
#include <scifi/material/landau.hpp>

namespace scifi {

/// What a particle loses on a path: sample(p, particle, medium, path, random) -> MeV, path in mm along the flight.
/// Law: never negative; no path, no loss; the losses of N pieces of a path, added, are distributed as the path's. Models: collision_loss, fixed_loss.
template <class T>
concept energy_loss_sampler = requires(const T sampler, double p, const particle hypothesis, const material medium, double path, random_stream random) {
  { sampler.sample(p, hypothesis, medium, path, random) } -> std::convertible_to<double>;
};

/// Electrons knocked on in a path that are worth following: those with at least `threshold` (kinetic energy, MeV).
struct knock_ons {
  double threshold;
  inline_vector<double, 16> energies{};  ///< MeV; when it is full, further electrons count as stopped where they are made
};

/// A sampler that also tells the electrons it knocks on: sample(p, particle, medium, path, random, knock_ons) -> MeV, their energies included.
template <class T>
concept knock_on_sampler = requires(const T sampler, double p, const particle hypothesis, const material medium, double path, random_stream random, knock_ons electrons) {
  { sampler.sample(p, hypothesis, medium, path, random, electrons) } -> std::convertible_to<double>;
};

/// The loss that an energy-loss policy gives, without fluctuation. `fixed_loss<no_energy_loss>` loses nothing.
template <energy_loss_policy Policy = mean_energy_loss>
struct fixed_loss {
  Policy policy{};

  [[nodiscard]] double sample(double p, const particle& hypothesis, const material& medium, double path, random_stream&) const {
    return policy.loss(p, hypothesis, whole(medium, path), 1.0).value;
  }
};

/// Loss made of single collisions: large transfers one by one, the many small ones as one fluctuating sum; the mean is Bethe's exactly.
///
/// Transfers T above a limit T_c come from dn/dT = xi (1 - beta^2 T/T_max) / T^2 (PDG 2024, eqs. 34.3, 34.4, spin 0), xi as in eq. 34.12;
/// their number is Poisson. The sum of those below has the rest of Bethe's mean and variance xi T_c (1 - beta^2 T_c / (2 T_max)).
/// So thin layers follow Landau's distribution cut at T_max, thicker ones Vavilov's, and pieces of a path add up to the path.
/// T_c = `limit` xi, where the sum below is nearly Gaussian, yet not under `excitations` I: electrons are not free there. A limit below 1e-4 counts as that.
/// The binding of the electrons widens the most probable part further where xi is below some 10 I (Blunck, Leisegang); that is left out.
struct collision_loss {
  double limit = 0.1;
  double excitations = 3.0;

  [[nodiscard]] double sample(double p, const particle& hypothesis, const material& medium, double path, random_stream& random) const {
    knock_ons none{std::numeric_limits<double>::infinity()};
    return sample(p, hypothesis, medium, path, random, none);
  }

  /// The same; transfers of at least `electrons.threshold` are appended to `electrons` and are part of the loss.
  [[nodiscard]] double sample(double p, const particle& hypothesis, const material& medium, double path, random_stream& random, knock_ons& electrons) const {
    if (!(path > 0.0) || !(medium.density > 0.0)) return 0.0;
    const ionisation_kinematics<double> k = ionisation_kinematics_of(p, hypothesis);
    const double xi = landau_xi(k, hypothesis, medium, path);
    const double largest = k.largest_transfer;
    constexpr double least_limit = 1.0e-4;  // 1/limit transfers are drawn on average
    const double cut = std::min(std::max(std::max(least_limit, limit) * xi, excitations * medium.mean_excitation_energy), largest);
    const double mean = mean_energy_loss_rate(p, hypothesis, medium).value * path;

    const double mean_above = xi * (std::log(largest / cut) - k.beta_squared * (1.0 - cut / largest));
    const double mean_below = std::max(mean - mean_above, 0.0);
    const double variance_below = xi * cut * (1.0 - 0.5 * k.beta_squared * cut / largest);
    double loss = sum_of_small(mean_below, variance_below, random);

    // Rutherford's 1/T^2 by inversion, then Mott's factor by rejection.
    const int candidates = random.poisson(xi * (1.0 / cut - 1.0 / largest));
    for (int i = 0; i < candidates; ++i) {
      const double transfer = 1.0 / random.uniform(1.0 / largest, 1.0 / cut);
      if (!(random.uniform() < 1.0 - k.beta_squared * transfer / largest)) continue;
      loss += transfer;
      if (transfer >= electrons.threshold) electrons.energies.push_back(transfer);
    }
    return loss;
  }

 private:
  /// A number >= 0 of given mean and variance: Gaussian where that is safe, else a Poisson number of equal transfers.
  [[nodiscard]] static double sum_of_small(double mean, double variance, random_stream& random) {
    if (!(mean > 0.0)) return 0.0;
    constexpr double safe_number = 36.0;  // six standard deviations from zero
    const double number = mean * mean / variance;
    if (number < safe_number) return random.poisson(number) * variance / mean;
    return std::max(mean + std::sqrt(variance) * random.normal(), 0.0);
  }
};

}  // namespace scifi
