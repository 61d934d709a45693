// SPDX-License-Identifier: MPL-2.0
#include "support/catch.hpp"

#include <scifi/study/goodness_of_fit.hpp>

using namespace scifi::study;

TEST_CASE("chi2 and p-value of tracks with degrees of freedom, merged", "[study]") {
  goodness_of_fit a, b;
  scifi::track t;
  t.ndf = 10;
  t.chi2 = 5.0;
  t.p_value = 0.25;
  a.add(t);
  t.p_value = 0.75;
  b.add(t);
  t.ndf = 0;
  b.add(t);
  a += b;
  CHECK(a.chi2_per_ndf.values.size() == 2);
  CHECK(a.chi2_per_ndf.values.values()[0] == 0.5);
  CHECK(a.of_p_value().count == 2);
  CHECK(a.of_p_value().distance == Approx(0.25));
}
