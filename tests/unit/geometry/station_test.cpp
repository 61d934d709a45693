// SPDX-License-Identifier: MPL-2.0
#include <scifi/geometry/station.hpp>

#include <cmath>

#include <scifi/geometry/mice.hpp>

#include "support/catch.hpp"

namespace {

scifi::station two_planes() {
  scifi::station s;
  for (int i = 0; i < 2; ++i) {
    scifi::plane p;
    p.central_channel = 10.0 + i;
    p.below.add(scifi::whole(scifi::materials::mylar, 0.1)).add(scifi::whole(scifi::materials::polystyrene, 0.3));
    p.above.add(scifi::whole(scifi::materials::aluminium, 0.2));
    s.planes.push_back(p);
  }
  return s;
}

}  // namespace

TEST_CASE("the channel sum of a station is the sum of its central channels", "[geometry]") {
  CHECK(two_planes().channel_sum() == 21.0);
  CHECK(scifi::station{}.channel_sum() == 0.0);
}

TEST_CASE("channels that see one point add up to the channel sum wherever it is", "[geometry]") {
  const scifi::station s = scifi::mice::fibre_station(1, scifi::vector<double, 3>::Zero());
  for (const double x : {-100.0, 0.0, 31.7})
    for (const double y : {-64.0, 0.0, 120.0}) {
      double channels = 0.0;
      double alphas = 0.0;
      for (const scifi::plane& p : s.planes) {
        const double alpha = x * std::cos(p.angle) + y * std::sin(p.angle);
        alphas += alpha;
        channels += p.channel_at(alpha);
      }
      CHECK(std::abs(alphas) < 1e-12);
      CHECK(channels == Approx(s.channel_sum()).epsilon(1e-13));
    }
}

TEST_CASE("a station made one layer tells every slab the radiation lengths of them all and changes nothing else", "[geometry]") {
  scifi::station s = two_planes();
  const scifi::station before = s;
  scifi::as_one_layer(s);
  const double total = 2.0 * (0.1 / scifi::materials::mylar.radiation_length + 0.3 / scifi::materials::polystyrene.radiation_length +
                              0.2 / scifi::materials::aluminium.radiation_length);
  for (std::size_t i = 0; i < 2; ++i) {
    REQUIRE(s.planes[i].below.size() == 2);
    REQUIRE(s.planes[i].above.size() == 1);
    for (const auto& stack : {s.planes[i].below, s.planes[i].above})
      for (const scifi::slab& one : stack) CHECK(one.layer_radiation_lengths == Approx(total).epsilon(1e-14));
    for (std::size_t k = 0; k < 2; ++k) {
      CHECK(s.planes[i].below[k].thickness == before.planes[i].below[k].thickness);
      CHECK(s.planes[i].below[k].medium.name == before.planes[i].below[k].medium.name);
    }
    CHECK(s.planes[i].above[0].medium.name == "aluminium");
  }
}
