// SPDX-License-Identifier: MPL-2.0
#include <scifi/alignment/chi2_scale.hpp>

#include <cmath>
#include <limits>

#include <scifi/core/random.hpp>

#include "support/catch.hpp"

using namespace scifi;
using alignment::chi2_scale;

TEST_CASE("the scale of chi2 is found for any degrees of freedom, in spite of outliers, and from parts", "[alignment]") {
  random_stream random(7, 0, 0);
  for (const double scale : {0.9, 1.0, 40.0}) {
    chi2_scale all, even, odd;
    constexpr int tracks = 20000;
    for (int i = 0; i < tracks; ++i) {
      const int ndf = 2 + i % 12;
      double chi2 = 0.0;
      for (int k = 0; k < ndf; ++k) chi2 += std::pow(random.normal(), 2);
      if (i % 100 == 0) chi2 *= 1e4;
      all.add(scale * chi2, ndf);
      (i % 2 == 0 ? even : odd).add(scale * chi2, ndf);
    }
    even += odd;
    CHECK(all.size() == tracks);
    CHECK(even.median() == all.median());
    // 2 % of the formula, 1 % that the outliers move the median, the bins.
    CHECK(all.median() == Approx(scale).epsilon(0.04));
  }
}

TEST_CASE("what is no chi2 does not count, and without tracks the scale is one", "[alignment]") {
  chi2_scale scale;
  scale.add(std::numeric_limits<double>::quiet_NaN(), 3);
  scale.add(-1.0, 3);
  scale.add(1.0, 0);
  CHECK(scale.size() == 0);
  CHECK(scale.median() == 1.0);
  scale.add(std::numeric_limits<double>::infinity(), 3);
  CHECK(scale.median() > 1e5);
  chi2_scale perfect;
  perfect.add(0.0, 3);
  CHECK(perfect.median() == Approx(1e-3).epsilon(0.03));
}
