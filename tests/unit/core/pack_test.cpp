// SPDX-License-Identifier: MPL-2.0
#include <scifi/core/pack.hpp>

#include <cmath>

#include <scifi/core/scalar.hpp>

#include "support/catch.hpp"

using namespace scifi;

namespace {

template <class Pack>
void check_arithmetic() {
  using T = typename Pack::value_type;
  Pack a, b;
  for (int i = 0; i < Pack::lanes; ++i) {
    a.set(i, static_cast<T>(i + 1));
    b.set(i, static_cast<T>(3 - i));
  }
  const Pack sum = a + b, difference = a - b, product = a * b, quotient = b / a, opposite = -a, root = sqrt(a), chosen = select(a < b, a, b);
  Pack changed = a;
  changed += b;
  changed *= a;
  changed -= b;
  changed /= a;
  const auto less = a < b, not_less = a >= b, both = less && a <= b, either = less || not_less;
  for (int i = 0; i < Pack::lanes; ++i) {
    const T x = static_cast<T>(i + 1), y = static_cast<T>(3 - i);
    CHECK(sum[i] == x + y);
    CHECK(difference[i] == x - y);
    CHECK(product[i] == x * y);
    CHECK(quotient[i] == y / x);
    CHECK(opposite[i] == -x);
    CHECK(root[i] == std::sqrt(x));
    CHECK(chosen[i] == (x < y ? x : y));
    CHECK(changed[i] == Approx(((x + y) * x - y) / x));
    CHECK(less[i] == (x < y));
    CHECK((!less)[i] == (x >= y));
    CHECK(not_less[i] == (x >= y));
    CHECK(both[i] == (x < y));
    CHECK(either[i]);
  }
  CHECK(any_of(less));
  CHECK_FALSE(all_of(less));
  CHECK(all_of(either));
  CHECK_FALSE(any_of(!either));
}

}  // namespace

TEST_CASE("packs of any width do in each lane what a number does", "[core]") {
  check_arithmetic<pack<double, 2>>();
  check_arithmetic<pack<double, 4>>();
  check_arithmetic<pack<double, 8>>();
  check_arithmetic<pack<float, 4>>();
  check_arithmetic<pack<float, 8>>();
  check_arithmetic<pack<float, 16>>();
}

TEST_CASE("any_of and all_of see each single lane of a mask", "[core]") {
  const auto check = []<class Mask>(Mask, int lanes) {
    for (int i = 0; i < lanes; ++i) {
      Mask one(false), others(true);
      one.set(i, true);
      others.set(i, false);
      CHECK(any_of(one));
      CHECK_FALSE(all_of(others));
      CHECK(any_of(others));
    }
    CHECK(all_of(Mask(true)));
    CHECK_FALSE(any_of(Mask(false)));
  };
  check(pack_mask<double, 4>(), 4);
  check(pack_mask<double, 8>(), 8);
  check(pack_mask<float, 8>(), 8);
  check(pack_mask<float, 16>(), 16);
}

TEST_CASE("a pack is a scalar of the core, also in Eigen's matrices", "[core]") {
  static_assert(scalar<pack<double>>);
  static_assert(scalar<pack<float>>);
  using matrix = Eigen::Matrix<pack<double>, 2, 2>;
  const matrix m = pack<double>(3) * matrix::Identity();
  const matrix product = m * m;
  CHECK(product(0, 0)[1] == 9.0);
  CHECK(product(0, 1)[0] == 0.0);
  CHECK(pack<float>(1)[0] == 1.0f);
  CHECK(all_of(is_finite(pack<double>(1.0))));
  CHECK_FALSE(any_of(is_finite(pack<double>(std::nan("")))));
}
