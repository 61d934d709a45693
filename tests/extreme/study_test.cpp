// SPDX-License-Identifier: MPL-2.0
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include <scifi/geometry/mice.hpp>
#include <scifi/information/mixture_spread.hpp>
#include <scifi/information/track_bound.hpp>
#include <scifi/study/binomial_interval.hpp>
#include <scifi/study/flatness.hpp>
#include <scifi/study/sample.hpp>

#include "extreme/extremes.hpp"
#include "support/catch.hpp"

using namespace scifi;
using test::all_finite;
using test::extremes;
using test::not_a_number;

TEST_CASE("a summary of values of which one is NaN is NaN, wherever the value stands", "[extreme]") {
  for (std::size_t at = 0; at < 40; ++at) {
    study::sample values;
    for (std::size_t i = 0; i < 40; ++i) values.add(i == at ? not_a_number : 0.01 * static_cast<double>((7 * i) % 40));
    const study::summary s = study::summarise(values);
    CHECK(s.count == 40);
    CHECK((std::isnan(s.mean) && std::isnan(s.median) && std::isnan(s.spread) && std::isnan(s.tail)));
    const study::flatness f = study::flatness_of(values);
    CHECK((std::isnan(f.distance) && std::isnan(f.probability)));
  }
}

TEST_CASE("the median does not mind values of any size", "[extreme]") {
  for (const double x : extremes) {
    if (std::isnan(x)) continue;
    study::sample values;
    for (const double v : {1.0, 2.0, 3.0, 4.0}) values.add(v);
    values.add(x);
    CHECK(study::summarise(values).median == (x < 2.0 ? 2.0 : 3.0));
  }
}

TEST_CASE("quantiles outside 0 .. 1 are not read off beside the values", "[extreme]") {
  const std::vector<double> sorted{1.0, 2.0, 4.0};
  for (const double q : extremes) {
    INFO(q);
    const double value = study::quantile(sorted, q);
    if (q >= 0.0 && q <= 1.0) CHECK((value >= 1.0 && value <= 4.0));
    else CHECK(std::isnan(value));
  }
  CHECK(study::quantile(sorted, 1.0) == 4.0);
}

TEST_CASE("an interval of a probability stays within 0 .. 1 for any width", "[extreme]") {
  for (const double sigmas : extremes)
    for (const double expected : {0.0, 1.0, 1e16, 1e300}) {
      const auto i = study::wilson_interval(0.5 * expected, expected, sigmas);
      CHECK((i.low >= 0.0 && i.high <= 1.0 && i.low <= i.high));
    }
}

TEST_CASE("the spread of a mixture is found for widths of any size", "[extreme]") {
  for (const double sigma : extremes) {
    INFO(sigma);
    const double spread = mixture_spread(std::vector<double>{sigma, sigma});
    if (!std::isfinite(sigma)) CHECK(std::isnan(spread));
    else if (sigma > 0.0 && sigma < 1e300) CHECK(spread == Approx(sigma).epsilon(1e-6));
    else CHECK(spread >= 0.0);
  }
}

TEST_CASE("a bound on a track of any numbers is known and finite, or not known", "[extreme]") {
  const detector both = mice::trackers();
  const tracker& t = *both.find(mice::downstream);
  for (const double x : extremes)
    for (int slot = 0; slot < 7; ++slot) {
      INFO("slot " << slot << " is " << x);
      vector<double, 5> truth;
      truth << 10.0, -20.0, 20.0, 10.0, 200.0;
      double field = 3.0 * units::tesla, prior = 0.01;
      (slot < 5 ? truth[slot] : slot == 5 ? field : prior) = x;
      const reference_bound b = make_track_bound(t, field, muon_plus, {}, prior)(truth, 1);
      if (b.known()) CHECK((all_finite(b.slopes.covariance) && b.pt >= 0.0));
      if (slot < 6 && !std::isfinite(x)) CHECK_FALSE(b.known());
    }
}
