// SPDX-License-Identifier: MPL-2.0
#include <stdexcept>

#include "support/catch.hpp"

#include <scifi/study/distribution.hpp>

using namespace scifi::study;

TEST_CASE("a distribution counts in half-open bins and keeps what lies outside", "[study]") {
  distribution d(4, 0.0, 2.0, "length [mm]");
  for (const double x : {-0.1, 0.0, 0.49, 0.5, 1.99, 2.0, 7.0}) d.add(x);
  CHECK(d.histogram.at(-1) == 1.0);
  CHECK(d.histogram.at(0) == 2.0);
  CHECK(d.histogram.at(1) == 1.0);
  CHECK(d.histogram.at(2) == 0.0);
  CHECK(d.histogram.at(3) == 1.0);
  CHECK(d.histogram.at(4) == 2.0);
  CHECK(d.values.size() == 7);
  CHECK(d.histogram.axis().metadata() == "length [mm]");
}

TEST_CASE("distributions filled apart are merged; other bins are refused", "[study]") {
  distribution a(4, 0.0, 2.0, "x"), b(4, 0.0, 2.0, "x");
  a.add(0.1);
  b.add(0.2);
  b.add(1.7);
  a += b;
  CHECK(a.histogram.at(0) == 2.0);
  CHECK(a.histogram.at(3) == 1.0);
  CHECK(a.values.size() == 3);
  CHECK_THROWS_AS((a += distribution(5, 0.0, 2.0, "x")), std::invalid_argument);
}
