// SPDX-License-Identifier: MPL-2.0
#include <scifi/arc/look_ahead.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <vector>

#include <scifi/core/random.hpp>

#include "support/catch.hpp"

using namespace scifi;

namespace {

using complex = std::complex<double>;
constexpr std::array<double, 5> station_z{0.0, 200.0, 450.0, 750.0, 1100.0};

/// Points of a helix with a random kink of this variance per projection at each station, blurred by `blur`; the last one given is exact.
std::vector<arc_point> flown(double w, complex slope, double kink, double blur, std::size_t count, random_stream& random) {
  std::vector<arc_point> out;
  complex at(5.0, -8.0);
  for (std::size_t i = 0; i < count; ++i) {
    const double error = i + 1 < count ? std::sqrt(blur) : 0.0;
    out.push_back({{at.real() + error * random.normal(), at.imag() + error * random.normal()}, blur, station_z[i]});
    slope += std::sqrt(kink) * complex(random.normal(), random.normal());
    if (i + 1 == count) break;
    const double dz = station_z[i + 1] - station_z[i];
    at += slope * (1.0 - std::exp(complex(0.0, -w * dz))) / complex(0.0, w);
    slope *= std::exp(complex(0.0, -w * dz));
  }
  return out;
}

chord_pair chords(const std::vector<arc_point>& p, double kink) {
  const std::size_t n = p.size() - 1;
  return {p[0], p[1], p[n - 2], p[n - 1], n == 3, static_cast<double>(n - 2) * kink, kink};
}

chord_turn next_turn(std::size_t last) { return {station_z[last - 1] - station_z[last - 2], station_z[last] - station_z[last - 1], 0.018}; }

}  // namespace

TEST_CASE("without errors the next point is where it is expected, from three points and from four", "[arc]") {
  random_stream random(1, 0, 0);
  for (const double w : {0.0005, -0.003, 0.006, -0.0085}) {
    for (const std::size_t last : {3U, 4U}) {
      const auto p = flown(w, {0.15, -0.2}, 0.0, 0.0, last + 1, random);
      const chord_pair seen = chords(p, 0.0);
      // Near enough to tell whole turns apart.
      const double found = seen.curvature(w + 0.3 / seen.lever());
      CHECK(found == Approx(w).epsilon(1e-9));
      const outlook there(seen, next_turn(last), found);
      CHECK(std::sqrt(norm(there.place() - p.back().position)) < 0.02);
      CHECK(there.along() == Approx(0.0).margin(1e-12));
    }
  }
}

TEST_CASE("the error of the expected place is the one stated across, and no larger than stated along", "[arc]") {
  random_stream random(2, 0, 0);
  constexpr int tracks = 4000;
  for (const double kink : {0.0, 2e-5}) {
    for (const double w : {0.002, -0.005}) {
      for (const std::size_t last : {3U, 4U}) {
        double along = 0.0, across = 0.0, distance = 0.0;
        for (int k = 0; k < tracks; ++k) {
          auto p = flown(w, {0.2, 0.15}, kink, 0.12, last + 1, random);
          p.back().variance = 0.0;
          const chord_pair seen = chords(p, kink);
          const outlook there(seen, next_turn(last), seen.curvature(w));
          const planar<double> off = conjugate(there.direction()) * (p.back().position - there.place());
          along += square(off.x) / there.along();
          across += square(off.y) / there.across();
          distance += there.distance2(p.back());
        }
        CAPTURE(kink, w, last);
        // A mean of squares of unit normals: standard deviation sqrt(2 / tracks).
        const double error = std::sqrt(2.0 / tracks);
        CHECK(across / tracks < 1.15 + 4.0 * error);
        CHECK(across / tracks > 0.7);
        CHECK(along / tracks < 1.0 + 4.0 * error);
        CHECK(along / tracks > 0.35);
        CHECK(distance / tracks == Approx((along + across) / tracks));
      }
    }
  }
}

TEST_CASE("the reach is the box around all points within a squared distance of one", "[arc]") {
  random_stream random(3, 0, 0);
  const auto p = flown(0.004, {0.2, 0.15}, 2e-5, 0.12, 4, random);
  const outlook there(chords(p, 2e-5), next_turn(3), 0.004);
  constexpr double variance = 0.1;
  const planar<double> reach = there.reach(variance);
  double furthest_x = 0.0, furthest_y = 0.0;
  for (int i = 0; i < 3600; ++i) {
    const double angle = i * constants::pi / 1800.0;
    const planar<double> off = there.direction() * planar<double>{std::sqrt(there.along() + variance) * std::cos(angle), std::sqrt(there.across() + variance) * std::sin(angle)};
    const arc_point edge{there.place() + off, variance, 750.0};
    REQUIRE(there.distance2(edge) == Approx(1.0));
    furthest_x = std::max(furthest_x, std::abs(off.x));
    furthest_y = std::max(furthest_y, std::abs(off.y));
  }
  CHECK(reach.x == Approx(furthest_x).epsilon(1e-4));
  CHECK(reach.y == Approx(furthest_y).epsilon(1e-4));
}

TEST_CASE("without a first chord nothing is known of the curvature, and the error says so", "[arc]") {
  random_stream random(4, 0, 0);
  auto p = flown(0.004, {0.2, 0.15}, 2e-5, 0.12, 4, random);
  p[1].position = p[0].position;
  CHECK_FALSE(std::isfinite(outlook(chords(p, 2e-5), next_turn(3), 0.004).along()));
}
