// SPDX-License-Identifier: MPL-2.0
// One fit, four kinds of number: double, float, and a pack of either with another track in each lane. The model is written once and knows nothing of it.
// Prints how far the kinds are apart beside the error of the fit, and fails where a lane is not what its track gives alone.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <vector>

#include <scifi/core/lane.hpp>
#include <scifi/core/pack.hpp>
#include <scifi/core/pack_math.hpp>
#include <scifi/core/random.hpp>
#include <scifi/core/units.hpp>
#include <scifi/kalman.hpp>
#include <scifi/track_model/fibre_measurement.hpp>
#include <scifi/track_model/helix_propagator.hpp>

namespace kalman = scifi::kalman;
using namespace scifi::literals;
using scifi::slope_state;

constexpr std::size_t planes = 15;
constexpr double distance = 75.0;    // mm between planes
constexpr double resolution = 0.43;  // mm
constexpr scifi::helix_propagator helix{3.0_T};

template <class Scalar>
struct readings {  // of one track, or of one in each lane
  scifi::vector<Scalar, 5> seed;
  std::array<Scalar, planes> alpha;
};

// [fit]
template <class Scalar>
kalman::estimate<Scalar, 5> fit(const readings<Scalar>& of) {
  const kalman::filter filter{helix, kalman::no_noise{}, kalman::symmetric_form{}};
  const scifi::vector<Scalar, 5> spread(Scalar(10.0), Scalar(0.1), Scalar(10.0), Scalar(0.1), Scalar(1e-3));
  kalman::estimate<Scalar, 5> now = kalman::uncorrelated(of.seed, spread);
  for (std::size_t i = 0; i < planes; ++i) {
    const double turn = static_cast<double>(i % 3) * 2.0 * scifi::constants::pi / 3.0;  // three planes, 120 degrees apart
    const scifi::fibre_measurement<slope_state, Scalar> seen{of.alpha[i], Scalar(resolution * resolution), std::cos(turn), std::sin(turn)};
    now = filter.update(filter.predict(now, distance), seen).posterior;
  }
  return now;
}
// [fit]

/// Tracks in double, with an idea of where they start and readings with Gaussian errors.
std::vector<readings<double>> simulate(std::size_t tracks) {
  scifi::random_stream random(8, 1, 0);
  std::vector<readings<double>> all(tracks);
  for (readings<double>& track : all) {
    scifi::vector<double, 5> x(20.0 * random.normal(), 0.1 * random.normal(), 20.0 * random.normal(), 0.1 * random.normal(), 1.0 / random.uniform(150.0, 250.0));
    track.seed = x + scifi::vector<double, 5>(random.normal(), 0.01 * random.normal(), random.normal(), 0.01 * random.normal(), 1e-4 * random.normal());
    for (std::size_t i = 0; i < planes; ++i) {
      x = helix.propagate(x, distance).state;
      const double turn = static_cast<double>(i % 3) * 2.0 * scifi::constants::pi / 3.0;
      track.alpha[i] = std::cos(turn) * x[slope_state::x] + std::sin(turn) * x[slope_state::y] + resolution * random.normal();
    }
  }
  return all;
}

// [lanes]
/// As many tracks as the scalar has lanes, from `first` on.
template <class Scalar>
readings<Scalar> in_lanes(const std::vector<readings<double>>& tracks, std::size_t first) {
  readings<Scalar> together;
  for (int lane = 0; lane < scifi::lane_count<Scalar>; ++lane) {
    const readings<double>& one = tracks[first + static_cast<std::size_t>(lane)];
    for (int i = 0; i < 5; ++i) scifi::set_lane(together.seed[i], lane, one.seed[i]);
    for (std::size_t i = 0; i < planes; ++i) scifi::set_lane(together.alpha[i], lane, one.alpha[i]);
  }
  return together;
}
// [lanes]

/// Largest distance between the fit in `Scalar` and the fit of the same track alone in `Alone`, in errors of the fit.
template <class Scalar, class Alone>
double apart(const std::vector<readings<double>>& tracks) {
  double most = 0.0;
  constexpr int width = scifi::lane_count<Scalar>;
  for (std::size_t first = 0; first < tracks.size(); first += static_cast<std::size_t>(width)) {
    const auto together = fit(in_lanes<Scalar>(tracks, first));
    for (int lane = 0; lane < width; ++lane) {
      const auto alone = fit(in_lanes<Alone>(tracks, first + static_cast<std::size_t>(lane)));
      for (int i = 0; i < 5; ++i) {
        const double difference = static_cast<double>(scifi::lane_of(together.mean[i], lane)) - static_cast<double>(alone.mean[i]);
        most = std::max(most, std::isfinite(difference) ? std::abs(difference) / std::sqrt(static_cast<double>(alone.covariance(i, i))) : 1e300);
      }
    }
  }
  return most;
}

int main() {
  const auto tracks = simulate(320);
  using doubles = scifi::pack<double>;
  using floats = scifi::pack<float>;
  const double d = apart<doubles, double>(tracks), f = apart<floats, float>(tracks), s = apart<float, double>(tracks);
  std::printf("%d doubles together and one alone: %.1e of the error of the fit\n", doubles::lanes, d);
  std::printf("%d floats together and one alone:  %.1e\n", floats::lanes, f);
  std::printf("float and double:                 %.1e\n", s);
  // Rounding of 15 steps, some hundred operations each, of numbers up to a thousand times their error.
  return d < 1e-9 && f < 0.05 && s < 0.05 ? 0 : 1;
}
