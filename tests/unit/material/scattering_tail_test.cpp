// SPDX-License-Identifier: MPL-2.0
#include <scifi/material/scattering_tail.hpp>

#include <array>
#include <cmath>
#include <cstddef>

#include <scifi/core/random.hpp>
#include <scifi/geometry/mice.hpp>
#include <scifi/material/highland.hpp>
#include <scifi/particle_to_hit/scattering_sampling.hpp>

#include "support/catch.hpp"

using namespace scifi;

TEST_CASE("the shares of the scattering law add up to one and its variances grow", "[material]") {
  const scattering_tail law;
  CHECK(law.share[0] + law.share[1] + law.share[2] == Approx(1.0));
  CHECK(law.variance[0] < law.variance[1]);
  CHECK(law.variance[1] < law.variance[2]);
}

TEST_CASE("the law is that of angles sampled collision by collision in a station", "[material]") {
  const scattering_tail law;
  const station s = mice::trackers().trackers[mice::downstream].stations[0];
  double layer = 0.0;
  for (const plane& p : s.planes) layer += radiation_lengths(p.below) + radiation_lengths(p.above);
  constexpr double p = 200.0;
  const double variance = highland_variance(p, muon_plus, layer, layer);
  constexpr std::array thresholds{0.5, 1.0, 2.0, 3.0, 4.0};  // of the angle in space, in Highland widths
  std::array<int, thresholds.size()> beyond{};
  constexpr int number = 40000;
  random_stream random(21, 0, 0);
  const coulomb_scattering scatter{};
  for (int i = 0; i < number; ++i) {
    vector<double, 2> sum = vector<double, 2>::Zero();
    for (const plane& one : s.planes)
      for (const auto* stack : {&one.below, &one.above})
        for (const slab& slice : *stack) sum += scatter.sample(p, muon_plus, slice, 1.0, random);
    for (std::size_t k = 0; k < thresholds.size(); ++k) beyond[k] += sum.squaredNorm() > thresholds[k] * thresholds[k] * variance;
  }
  for (std::size_t k = 0; k < thresholds.size(); ++k) {
    double expected = 0.0;  // a Gaussian in space exceeds r with probability exp(-r^2/2v)
    for (std::size_t i = 0; i < law.components; ++i) expected += law.share[i] * std::exp(-0.5 * thresholds[k] * thresholds[k] / law.variance[i]);
    INFO("angles beyond " << thresholds[k] << " widths");
    // Three Gaussians follow the fall of the density as 1/angle^4 to 15 %; the core, which holds more than scattering, is 7 % wider in variance.
    CHECK(static_cast<double>(beyond[k]) / number == Approx(expected).epsilon(0.15).margin(0.002));
    if (k < 2) CHECK(static_cast<double>(beyond[k]) / number == Approx(expected).margin(0.04));
  }
}
