// SPDX-License-Identifier: MPL-2.0
#include <scifi/core/linalg.hpp>

#include <type_traits>

#include "support/catch.hpp"

TEST_CASE("a symmetrised matrix is symmetric to the last bit and the mean of the matrix and its transpose", "[core]") {
  scifi::matrix<double, 3, 3> m;
  m << 1.0, 0.1, 7.0, 0.3, 2.0, -1.0 / 3.0, 7.0, 1.0 / 7.0, 3.0;
  const auto s = scifi::symmetrised<double, 3>(m);
  CHECK((s - s.transpose()).cwiseAbs().maxCoeff() == 0.0);
  CHECK((s - 0.5 * (m + m.transpose())).cwiseAbs().maxCoeff() == 0.0);
  CHECK(s.trace() == 6.0);
}

TEST_CASE("symmetrising what is symmetric changes no bit", "[core]") {
  scifi::matrix<float, 2, 2> m;
  m << 0.1f, 0.7f, 0.7f, 3.0f;
  CHECK((scifi::symmetrised<float, 2>(m) - m).cwiseAbs().maxCoeff() == 0.0f);
}

TEST_CASE("vectors and matrices have fixed sizes and hold no pointer", "[core]") {
  CHECK(sizeof(scifi::vector<double, 5>) == 5 * sizeof(double));
  CHECK(sizeof(scifi::matrix<double, 5, 5>) == 25 * sizeof(double));
  CHECK(std::is_trivially_destructible_v<scifi::matrix<double, 2, 5>>);
}
