// SPDX-License-Identifier: MPL-2.0
#include <cmath>
#include <vector>

#include "support/catch.hpp"
#include "support/flown_particle.hpp"

#include <scifi/geometry/mice.hpp>
#include <scifi/study/efficiency.hpp>

using namespace scifi;
using namespace scifi::study;

TEST_CASE("efficiency counts by true pt and |pz| and is merged", "[study]") {
  const detector d = mice::trackers();
  const auto particle = [&](double pt, double pz) {
    static std::vector<crossing> kept;
    kept = test::flown_particle(*d.find(1), 1, test::five(0, 0, 0.6 * pt, 0.8 * pt, pz), 0.9);
    return true_tracks(*d.find(1), kept).at(0);
  };
  efficiency a({.pt = {0, 10, 50}, .pz = {100, 200, 300}}), b({.pt = {0, 10, 50}, .pz = {100, 200, 300}});
  a.add(particle(5, 150), true);
  a.add(particle(5, 150), false);
  b.add(particle(5, -250), true);  // backwards
  b.add(particle(20, 150), true);
  b.add(particle(80, 150), false);
  a += b;
  CHECK(a.all().expected == 5);
  CHECK(a.all().found == 3);
  CHECK(a.all().value() == Approx(0.6));
  CHECK(a.grid().at(0, 0).expected == 2);
  CHECK(a.grid().at(0, 0).found == 1);
  CHECK(a.grid().at(0, 1).found == 1);
  CHECK(in_pz(a.grid()).at(0).expected == 4);
  CHECK(a.all().interval().low < 0.6);
  CHECK(std::isnan(found_share{}.value()));
}
