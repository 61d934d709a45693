// SPDX-License-Identifier: MPL-2.0
#include <scifi/particle_to_hit/fibre_layer.hpp>

#include <cmath>

#include <scifi/geometry/mice.hpp>

#include "support/catch.hpp"

using namespace scifi;

TEST_CASE("the layers of a tracker are its planes in order of growing z, each with its own channels", "[particle_to_hit]") {
  const auto layers = fibre_layers(mice::trackers().trackers[1]);
  REQUIRE(layers.size() == 15);
  for (std::size_t i = 0; i < layers.size(); ++i) {
    CHECK(layers[i].at.station == static_cast<int>(i) / 3 + 1);
    CHECK(layers[i].at.plane == static_cast<int>(i) % 3);
    CHECK(layers[i].of.channels == (layers[i].at.plane == 2 ? 212 : 214));
    if (i > 0) CHECK(layers[i].at.z > layers[i - 1].at.z);
  }
}

TEST_CASE("a point lies in the core whose axis is nearer than the radius, in none between the cores and beyond the last fibre", "[particle_to_hit]") {
  const plane p = mice::fibre_plane("U", 0.0, 212, 105.5, 0.0);
  const fibre_doublet doublet;
  for (const int fibre : {0, 1, 700, 741, 742, 1482, 1483}) {
    const double axis = fibre_alpha(p, doublet, fibre);
    const double height = row_height(doublet, fibre % 2);
    CHECK(core_at(p, doublet, axis, height) == fibre);
    for (double angle = 0.0; angle < 6.2; angle += 0.31) {
      CHECK(core_at(p, doublet, axis + 0.1539 * std::cos(angle), height + 0.1539 * std::sin(angle)) == fibre);
      const int other = core_at(p, doublet, axis + 0.1541 * std::cos(angle), height + 0.1541 * std::sin(angle));
      CHECK(other != fibre);
    }
  }
  CHECK(core_at(p, doublet, fibre_alpha(p, doublet, 1484), row_height(doublet, 0)) == -1);
  CHECK(core_at(p, doublet, fibre_alpha(p, doublet, -2), row_height(doublet, 0)) == -1);
  CHECK(core_at(p, doublet, 0.0, 0.3) == -1);
}

TEST_CASE("along a line the points in cores are the chords of the crossings", "[particle_to_hit]") {
  const plane p = mice::fibre_plane("U", 0.0, 212, 105.5, 0.0);
  const fibre_doublet doublet;
  const vector<double, 3> d = vector<double, 3>(0.3, 0.2, 1.0).normalized();
  double chords = 0.0;
  for (const int row : {0, 1})
    for (const fibre_crossing& c : fibre_crossings(p, doublet, row, 12.345, 0.0, d)) chords += c.chord;
  constexpr double step = 1e-5;
  double inside = 0.0;
  for (double s = -1.0; s < 1.0; s += step)
    if (core_at(p, doublet, 12.345 + s * d.x(), s * d.z()) >= 0) inside += step;
  CHECK(inside == Approx(chords).margin(10.0 * step));
}
