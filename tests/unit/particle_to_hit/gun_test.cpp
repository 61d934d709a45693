// SPDX-License-Identifier: MPL-2.0
#include <scifi/particle_to_hit/gun.hpp>

#include <cmath>
#include <stdexcept>
#include <string>

#include <scifi/geometry/mice.hpp>

#include "support/catch.hpp"
#include "support/message_of.hpp"

using namespace scifi;

TEST_CASE("the beam keeps its bounds and fills them evenly", "[particle_to_hit]") {
  flat_beam beam;
  beam.pz_min = 200.0;
  beam.pz_max = 260.0;
  beam.pt_min = 10.0;
  beam.pt_max = 90.0;
  random_stream random(1, 0, 0);
  constexpr int n = 20000;
  double pz = 0.0, pt = 0.0, r2 = 0.0, x = 0.0, px = 0.0;
  for (int i = 0; i < n; ++i) {
    const moving_particle m = beam.shoot(-30.0, +1, random);
    const double transverse = std::hypot(m.momentum.x(), m.momentum.y());
    const double radius2 = m.position.head<2>().squaredNorm();
    REQUIRE(m.momentum.z() >= 200.0);
    REQUIRE(m.momentum.z() <= 260.0);
    REQUIRE(transverse >= 10.0 - 1e-9);
    REQUIRE(transverse <= 90.0 + 1e-9);
    REQUIRE(radius2 <= 110.0 * 110.0 * (1.0 + 1e-12));
    REQUIRE(m.position.z() == -30.0);
    pz += m.momentum.z() / n;
    pt += transverse / n;
    r2 += radius2 / n;
    x += m.position.x() / n;
    px += m.momentum.x() / n;
  }
  // Uniform: variance width^2 / 12; the squared radius is uniform on a disc; x has variance R^2 / 4; px that of <pt^2> / 2.
  const double five = 5.0 / std::sqrt(static_cast<double>(n));
  CHECK(std::abs(pz - 230.0) < five * 60.0 / std::sqrt(12.0));
  CHECK(std::abs(pt - 50.0) < five * 80.0 / std::sqrt(12.0));
  CHECK(std::abs(r2 - 6050.0) < five * 12100.0 / std::sqrt(12.0));
  CHECK(std::abs(x) < five * 55.0);
  CHECK(std::abs(px) < five * std::sqrt((50.0 * 50.0 + 6400.0 / 12.0) / 2.0));
}

TEST_CASE("no particle is steeper than the limit", "[particle_to_hit]") {
  flat_beam beam;
  random_stream random(2, 0, 0);
  for (int i = 0; i < 5000; ++i) {
    const moving_particle m = beam.shoot(0.0, -1, random);
    REQUIRE(m.momentum.z() < 0.0);
    REQUIRE(std::hypot(m.momentum.x(), m.momentum.y()) <= 0.5 * std::abs(m.momentum.z()) * (1.0 + 1e-12));
  }
}

TEST_CASE("the beam starts before the first station that it meets and flies into the tracker", "[particle_to_hit]") {
  const detector d = mice::trackers();
  random_stream random(3, 0, 0);
  const moving_particle downstream = flat_beam{}.shoot(*d.find(mice::downstream), random);
  CHECK(downstream.position.z() == Approx(-30.0));
  CHECK(downstream.momentum.z() > 0.0);
  const moving_particle upstream = flat_beam{}.shoot(*d.find(mice::upstream), random);
  CHECK(upstream.position.z() == Approx(1099.7578 + 30.0));
  CHECK(upstream.momentum.z() < 0.0);
}

TEST_CASE("a beam from which nothing can be drawn is refused by name", "[particle_to_hit]") {
  const auto refused = [](auto change, const char* culprit) {
    flat_beam beam;
    change(beam);
    const std::string message = test::message_of<std::invalid_argument>([&beam] { beam.check(); });
    CAPTURE(culprit, message);
    CHECK(message.find(culprit) != std::string::npos);
  };
  CHECK_NOTHROW(flat_beam{}.check());
  refused([](flat_beam& b) { b.pz_min = 300.0; }, "pz");
  refused([](flat_beam& b) { b.pt_min = -1.0; }, "pt");
  refused([](flat_beam& b) { b.pt_min = b.pt_max = 200.0; }, "slope");
  refused([](flat_beam& b) { b.radius = -1.0; }, "radius");
  refused([](flat_beam& b) { b.hypothesis.charge = 0; }, "charged");
}
