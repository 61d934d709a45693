// SPDX-License-Identifier: MPL-2.0
#include <scifi/core/random.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include "support/catch.hpp"

using scifi::random_stream;

namespace {

constexpr int draws = 200000;
/// Five standard deviations: with fixed seeds a failure is a defect, not bad luck (5.7e-7 per check for a fresh seed).
constexpr double sigmas = 5.0;

/// Raw moments of numbers drawn from a stream.
struct moments {
  double mean = 0.0, variance = 0.0, third = 0.0;
};

template <class Draw>
moments sampled(Draw draw) {
  std::vector<double> x(draws);
  for (double& v : x) v = draw();
  moments m;
  for (const double v : x) m.mean += v / draws;
  for (const double v : x) {
    m.variance += (v - m.mean) * (v - m.mean) / draws;
    m.third += (v - m.mean) * (v - m.mean) * (v - m.mean) / draws;
  }
  return m;
}

/// Standard errors of mean and variance from variance and fourth central moment.
double error_of_mean(double variance) { return sigmas * std::sqrt(variance / draws); }
double error_of_variance(double variance, double fourth) { return sigmas * std::sqrt((fourth - variance * variance) / draws); }

}  // namespace

TEST_CASE("the words of a stream are those of Philox at the documented counter", "[core]") {
  const std::uint64_t seed = 0x0123456789abcdefu;
  const std::uint64_t event = 0xfedcba9876543210u;
  random_stream stream(seed, event, 3, 77);
  for (std::uint32_t block = 0; block < 3; ++block) {
    const auto words = scifi::philox4x32_10({block, 3u << 24 | 77u, 0x76543210u, 0xfedcba98u}, {0x89abcdefu, 0x01234567u});
    CHECK(stream.bits() == (std::uint64_t{words[0]} << 32 | words[1]));
    CHECK(stream.bits() == (std::uint64_t{words[2]} << 32 | words[3]));
  }
}

TEST_CASE("streams of different seed, event, stage or index differ and equal ones agree", "[core]") {
  const auto first = [](random_stream s) { return s.bits(); };
  const std::uint64_t reference = first({1, 2, 3, 4});
  CHECK(first({1, 2, 3, 4}) == reference);
  CHECK(first({0, 2, 3, 4}) != reference);
  CHECK(first({1, 3, 3, 4}) != reference);
  CHECK(first({1, 2, 2, 4}) != reference);
  CHECK(first({1, 2, 3, 5}) != reference);
  CHECK(first({1 + (1ull << 32), 2, 3, 4}) != reference);
  CHECK(first({1, 2 + (1ull << 32), 3, 4}) != reference);
}

TEST_CASE("uniform numbers fill (0, 1) evenly and successive ones are independent", "[core]") {
  random_stream stream(11, 0, 0);
  std::vector<int> bins(100, 0);
  double product = 0.0, last = stream.uniform();
  for (int i = 0; i < draws; ++i) {
    const double u = stream.uniform();
    REQUIRE(u > 0.0);
    REQUIRE(u < 1.0);
    ++bins[static_cast<std::size_t>(u * 100.0)];
    product += (u - 0.5) * (last - 0.5) / draws;
    last = u;
  }
  double chi2 = 0.0;
  for (const int n : bins) chi2 += std::pow(n - draws / 100.0, 2) / (draws / 100.0);
  // chi2 of 99 degrees of freedom: variance 2 * 99.
  CHECK(std::abs(chi2 - 99.0) < sigmas * std::sqrt(2.0 * 99.0));
  // The product of two independent centred uniforms has variance 1/144.
  CHECK(std::abs(product) < sigmas / 12.0 / std::sqrt(static_cast<double>(draws)));
}

TEST_CASE("normal numbers have the moments and the quantiles of the normal distribution", "[core]") {
  random_stream stream(12, 0, 0);
  const moments m = sampled([&] { return stream.normal(); });
  CHECK(std::abs(m.mean) < error_of_mean(1.0));
  CHECK(std::abs(m.variance - 1.0) < error_of_variance(1.0, 3.0));
  CHECK(std::abs(m.third) < sigmas * std::sqrt(15.0 / draws));

  for (const double x : {-2.5, -1.0, 0.3, 1.5, 3.0}) {
    random_stream again(13, 0, 0);
    int below = 0;
    for (int i = 0; i < draws; ++i) below += again.normal() < x;
    const double expected = 0.5 * std::erfc(-x / std::sqrt(2.0));
    CHECK(std::abs(below / static_cast<double>(draws) - expected) < sigmas * std::sqrt(expected * (1.0 - expected) / draws));
  }
}

TEST_CASE("exponential numbers have mean and variance one", "[core]") {
  random_stream stream(14, 0, 0);
  const moments m = sampled([&] { return stream.exponential(); });
  CHECK(std::abs(m.mean - 1.0) < error_of_mean(1.0));
  CHECK(std::abs(m.variance - 1.0) < error_of_variance(1.0, 9.0));
}

TEST_CASE("Poisson numbers have mean, variance and probabilities of the Poisson distribution, below and above the length of a piece", "[core]") {
  for (const double mean : {0.01, 0.8, 5.0, 15.9, 40.0, 200.0}) {
    random_stream stream(15, 0, 0);
    int zeros = 0;
    const moments m = sampled([&] {
      const int n = stream.poisson(mean);
      zeros += n == 0;
      return static_cast<double>(n);
    });
    CAPTURE(mean);
    CHECK(std::abs(m.mean - mean) < error_of_mean(mean));
    CHECK(std::abs(m.variance - mean) < error_of_variance(mean, mean * (1.0 + 3.0 * mean)));
    const double none = std::exp(-mean);
    CHECK(std::abs(zeros / static_cast<double>(draws) - none) <= sigmas * std::sqrt(none * (1.0 - none) / draws) + 1e-12);
  }
}

TEST_CASE("Poisson numbers of mean zero are zero", "[core]") {
  random_stream stream(16, 0, 0);
  CHECK(stream.poisson(0.0) == 0);
  CHECK(stream.poisson(-1.0) == 0);
}

TEST_CASE("Poisson numbers under the condition of not being zero keep the proportions of the others", "[core]") {
  const double mean = 0.7;
  random_stream stream(17, 0, 0);
  int ones = 0;
  const moments m = sampled([&] {
    const int n = stream.poisson_above_zero(mean);
    ones += n == 1;
    return static_cast<double>(n);
  });
  const double some = 1.0 - std::exp(-mean);
  const double expected_mean = mean / some;
  const double expected_variance = (mean + mean * mean) / some - expected_mean * expected_mean;
  const double one = mean * std::exp(-mean) / some;
  CHECK(std::abs(m.mean - expected_mean) < error_of_mean(expected_variance));
  CHECK(std::abs(ones / static_cast<double>(draws) - one) < sigmas * std::sqrt(one * (1.0 - one) / draws));
  for (int i = 0; i < 1000; ++i) REQUIRE(stream.poisson_above_zero(1e-3) >= 1);
}
