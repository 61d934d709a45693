// SPDX-License-Identifier: MPL-2.0
#include <scifi/particle_to_hit/fibre_crossing.hpp>

#include <cmath>

#include <scifi/core/constants.hpp>
#include <scifi/core/random.hpp>
#include <scifi/geometry/mice.hpp>

#include "support/catch.hpp"

using namespace scifi;

namespace {

const fibre_doublet doublet;
const plane view = mice::fibre_plane("U", 0.0, 212, 105.5, 0.0);
const vector<double, 3> straight_on{0.0, 0.0, 1.0};

}  // namespace

TEST_CASE("the middle fibre of a channel lies at the channel's alpha and neighbours half a pitch apart", "[particle_to_hit]") {
  for (const int channel : {0, 57, 105, 211}) {
    CHECK(channel_of_fibre(doublet, 7 * channel + 3) == channel);
    CHECK(fibre_alpha(view, doublet, 7 * channel + 3) == Approx(view.alpha(channel)).margin(1e-12));
  }
  CHECK(fibre_alpha(view, doublet, 100) - fibre_alpha(view, doublet, 101) == Approx(0.2135));
  CHECK(channel_of_fibre(doublet, 6) == 0);
  CHECK(channel_of_fibre(doublet, 7) == 1);
  // Fibres fill the plane evenly about its middle: the first and the last are as far from it.
  CHECK(fibre_alpha(view, doublet, 0) == Approx(-fibre_alpha(view, doublet, 212 * 7 - 1)));
}

TEST_CASE("a track through the axis of a core has the diameter as its chord, longer with its angle along the fibre", "[particle_to_hit]") {
  for (const int fibre : {700, 701}) {
    const int row = fibre % 2;
    const double alpha = fibre_alpha(view, doublet, fibre);
    const auto crossed = fibre_crossings(view, doublet, row, alpha, 0.0, straight_on);
    REQUIRE(crossed.size() == 1);
    CHECK(crossed[0].fibre == fibre);
    CHECK(crossed[0].chord == Approx(0.308));
    CHECK(crossed[0].entry == Approx(row_height(doublet, row) - 0.154));
    CHECK(fibre_crossings(view, doublet, 1 - row, alpha, 0.0, straight_on).empty());  // in the other row the cores end 59 um away

    const vector<double, 3> along = vector<double, 3>(0.0, 0.6, 0.8);
    CHECK(fibre_crossings(view, doublet, row, alpha, 0.0, along)[0].chord == Approx(0.308 / 0.8));
  }
}

TEST_CASE("a track that misses the axis has the chord of its distance", "[particle_to_hit]") {
  const double alpha = fibre_alpha(view, doublet, 700);
  const auto crossed = fibre_crossings(view, doublet, 0, alpha + 0.1, 0.0, straight_on);
  REQUIRE(crossed.size() == 1);
  CHECK(crossed[0].chord == Approx(2.0 * std::sqrt(0.154 * 0.154 - 0.01)));
  CHECK(fibre_crossings(view, doublet, 0, alpha + 0.155, 0.0, straight_on).empty());
  CHECK(fibre_crossings(view, doublet, 0, alpha + 0.2135, 0.0, straight_on).empty());
}

TEST_CASE("an inclined track's crossing is where the surface of the core is", "[particle_to_hit]") {
  random_stream random(1, 0, 0);
  int seen = 0;
  for (int i = 0; i < 500; ++i) {
    const double alpha = random.uniform(-100.0, 100.0);
    const double height = random.uniform(-0.3, 0.3);
    const vector<double, 3> d = vector<double, 3>(random.uniform(-2.0, 2.0), random.uniform(-1.0, 1.0), i % 2 == 0 ? 1.0 : -1.0).normalized();
    double before = -1e9;
    for (const int row : {0, 1}) {
      before = -1e9;
      for (const fibre_crossing& c : fibre_crossings(view, doublet, row, alpha, height, d)) {
        ++seen;
        REQUIRE(c.fibre % 2 == row);
        REQUIRE(c.entry >= before);
        before = c.entry;
        for (const double path : {c.entry, c.entry + c.chord}) {
          const double across = alpha + path * d.x() - fibre_alpha(view, doublet, c.fibre);
          const double up = height + path * d.z() - row_height(doublet, row);
          REQUIRE(std::hypot(across, up) == Approx(0.154).epsilon(1e-9));
        }
      }
    }
  }
  CHECK(seen > 500);
}

TEST_CASE("the mean path in cores is the area of a core over the distance of the fibres", "[particle_to_hit]") {
  for (const double slope : {0.0, 0.4}) {
    const vector<double, 3> d = vector<double, 3>(slope, 0.0, 1.0).normalized();
    constexpr int n = 20000;
    double sum = 0.0;
    for (int i = 0; i < n; ++i) {
      // An even comb over whole pitches in place of random numbers.
      const double alpha = 10.0 * doublet.pitch * (i + 0.5) / n;
      for (const int row : {0, 1})
        for (const fibre_crossing& c : fibre_crossings(view, doublet, row, alpha, 0.0, d)) sum += c.chord / n;
    }
    // Cavalieri: the area of a core, per pitch and row, along a path that is 1/cos longer. Midpoint rule with square-root edges: (step/width)^1.5.
    const double expected = constants::pi / 4.0 * 0.308 * 0.308 / 0.2135 / d.z();
    CHECK(sum == Approx(expected).epsilon(1e-4));
  }
}

TEST_CASE("outside the plane there are no fibres", "[particle_to_hit]") {
  CHECK(fibre_crossings(view, doublet, 0, 170.0, 0.0, straight_on).empty());
  CHECK(fibre_crossings(view, doublet, 1, -1e6, 0.0, straight_on).empty());
  const auto grazing = fibre_crossings(view, doublet, 0, 0.0, 0.0, vector<double, 3>(1.0, 0.0, 1e-3).normalized());
  CHECK(grazing.size() <= max_fibre_crossings);
}
