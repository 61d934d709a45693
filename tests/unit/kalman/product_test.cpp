// SPDX-License-Identifier: MPL-2.0
#include "support/catch.hpp"

#include <algorithm>
#include <limits>

#include <scifi/kalman/product.hpp>

#include "unit/kalman/models.hpp"

namespace detail = scifi::kalman::detail;

namespace {

template <class Scalar, int Rows, int K, int Cols>
void check_products(std::mt19937_64& engine) {
  const scifi::matrix<Scalar, Rows, K> a = models::random_matrix<Rows, K>(engine).template cast<Scalar>();
  const scifi::matrix<Scalar, K, Cols> b = models::random_matrix<K, Cols>(engine).template cast<Scalar>();
  const scifi::vector<Scalar, K> x = models::random_matrix<K, 1>(engine).template cast<Scalar>();
  const scifi::matrix<Scalar, Rows, Cols> base = models::random_matrix<Rows, Cols>(engine).template cast<Scalar>();
  // K products, each rounded once, and their sums; the comparison is made in double.
  const double tolerance = 4.0 * K * std::max(static_cast<double>(std::numeric_limits<Scalar>::epsilon()), std::numeric_limits<double>::epsilon());
  const Eigen::MatrixXd wide_a = a.template cast<double>(), wide_b = b.template cast<double>();
  const auto close = [&](const Eigen::MatrixXd& found, const Eigen::MatrixXd& expected) { return (found - expected).norm() <= tolerance * (1.0 + wide_a.norm() * (1.0 + wide_b.norm())); };
  CHECK(close(detail::times<Scalar, Rows, K, Cols>(a, b).template cast<double>(), wide_a * wide_b));
  CHECK(close(detail::times_transposed<Scalar, Rows, K, Cols>(a, detail::transposed<Scalar, K, Cols>(b)).template cast<double>(), wide_a * wide_b));
  CHECK(close(detail::times_vector<Scalar, Rows, K>(a, x).template cast<double>(), wide_a * x.template cast<double>()));
  scifi::matrix<Scalar, Rows, Cols> out;
  detail::set_difference(out, base, a, [&b](int k, int j) { return b(k, j); });
  CHECK(close(out.template cast<double>(), base.template cast<double>() - wide_a * wide_b));
  detail::copy_columns<Scalar, Rows, Cols>(out, base);
  CHECK(out == base);
}

}  // namespace

TEST_CASE("products of small matrices are Eigen's", "[kalman]") {
  std::mt19937_64 engine(2);
  for (int trial = 0; trial < 10; ++trial) {
    check_products<double, 1, 1, 1>(engine);
    check_products<double, 5, 5, 5>(engine);
    check_products<double, 5, 5, 1>(engine);
    check_products<double, 5, 1, 5>(engine);
    check_products<double, 6, 3, 2>(engine);
    check_products<double, 9, 9, 3>(engine);
    check_products<float, 5, 4, 6>(engine);
    check_products<long double, 4, 5, 3>(engine);
  }
}

TEST_CASE("a column is scaled and subtracted in place", "[kalman]") {
  scifi::matrix<double, 3, 2> m;
  m << 1, 2, 3, 4, 5, 6;
  detail::subtract_column<double, 3, 2>(m, 0, 1, 2.0);
  CHECK(m.col(1) == Eigen::Vector3d(0, -2, -4));
  detail::set_scaled_column<double, 3, 2>(m, m, 0, 3.0);
  CHECK(m.col(0) == Eigen::Vector3d(3, 9, 15));
}
