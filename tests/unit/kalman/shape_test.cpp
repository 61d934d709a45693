// SPDX-License-Identifier: MPL-2.0
#include "support/catch.hpp"

#include <scifi/kalman/shape.hpp>

namespace kalman = scifi::kalman;

TEST_CASE("a plain number counts as a matrix of one row and one column", "[kalman]") {
  STATIC_REQUIRE(kalman::detail::shaped<double, 1, 1>);
  STATIC_REQUIRE(kalman::detail::shaped<const scifi::matrix<float, 2, 3>&, 2, 3>);
  STATIC_REQUIRE_FALSE(kalman::detail::shaped<scifi::matrix<float, 2, 3>, 3, 2>);
  STATIC_REQUIRE_FALSE(kalman::detail::fixed_size<Eigen::MatrixXd>);
  CHECK(kalman::detail::as_matrix<double, 1, 1>(2.5F)(0, 0) == 2.5);
}

TEST_CASE("a matrix is converted to the wanted scalar", "[kalman]") {
  const scifi::vector<float, 2> v(1.5F, -2.0F);
  const scifi::vector<double, 2> w = kalman::detail::as_matrix<double, 2, 1>(v);
  CHECK(w(0) == 1.5);
  CHECK(w(1) == -2.0);
}

TEST_CASE("a bounded matrix holds its maximum inside itself", "[kalman]") {
  using bounded = kalman::bounded_matrix<double, Eigen::Dynamic, 5, 1, 5>;
  STATIC_REQUIRE(sizeof(bounded) >= 5 * sizeof(double));
  bounded m(1, 5);
  const void* const data = m.data();
  CHECK(data >= static_cast<const void*>(&m));
  CHECK(data < static_cast<const void*>(&m + 1));
}
