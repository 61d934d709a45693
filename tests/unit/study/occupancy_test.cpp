// SPDX-License-Identifier: MPL-2.0
#include "support/catch.hpp"

#include <scifi/study/occupancy.hpp>

using namespace scifi;
using namespace scifi::study;

TEST_CASE("an event is counted by tracker, an empty one as nothing", "[study]") {
  event e;
  e.digits = {{{0, 1, 0, 5}, 4.0}, {{1, 1, 0, 5}, 6.0}, {{1, 1, 0, 6}, 3.0}};
  cluster c;
  c.tracker = 1;
  c.npe = 9.0;
  c.size = 2;
  e.clusters = {c};
  space_point p;
  p.tracker = 1;
  for (int i = 0; i < 3; ++i) p.clusters.push_back(i);
  space_point doublet;
  doublet.tracker = 1;
  for (int i = 0; i < 2; ++i) doublet.clusters.push_back(i);
  e.space_points = {p, doublet};
  occupancy here, there;
  here.add(e, 1);
  there.add({}, 1);
  here += there;
  CHECK(summarise(here.digits.values).mean == 1.0);
  CHECK(here.clusters.values.values()[0] == 1.0);
  CHECK(here.space_points.values.values()[0] == 2.0);
  CHECK(here.triplets.values.values()[0] == 1.0);
  CHECK(here.digit_light.values.size() == 2);
  CHECK(summarise(here.digit_light.values).mean == 4.5);
  CHECK(here.cluster_light.values.values()[0] == 9.0);
  CHECK(here.cluster_size.values.values()[0] == 2.0);
  CHECK(here.digits.histogram.at(2) == 1.0);
  CHECK(here.digits.histogram.at(0) == 1.0);
}
