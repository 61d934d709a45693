// SPDX-License-Identifier: MPL-2.0
#include "support/catch.hpp"

#include <array>

#include <scifi/kalman/column.hpp>

namespace detail = scifi::kalman::detail;

#if defined(__GNUC__)

namespace {

template <class Scalar, int N>
void check_column() {
  std::array<Scalar, N + 2> a{}, b{}, out{};
  for (std::size_t i = 0; i < N + 2; ++i) {
    a[i] = static_cast<Scalar>(i + 1);
    b[i] = static_cast<Scalar>(10 * (i + 1));
  }
  using column = detail::column<Scalar, N>;
  column c = column::load(a.data()).times(Scalar(2));
  c.add(column::load(b.data()), Scalar(3));
  c.subtract(column::load(a.data()), Scalar(1));
  c.add(column::load(a.data()));
  c.template set<N - 1>(Scalar(-5));
  c.store(out.data());
  for (std::size_t i = 0; i + 1 < N; ++i) CHECK(out[i] == 2 * a[i] + 3 * b[i]);
  CHECK(out[N - 1] == Scalar(-5));
  CHECK(out[N] == Scalar(0));  // nothing is written behind the end
}

}  // namespace

TEST_CASE("a column of any length is handled entry by entry and nothing behind it is touched", "[kalman]") {
  check_column<double, 1>();
  check_column<double, 2>();
  check_column<double, 3>();
  check_column<double, 5>();
  check_column<double, 7>();
  check_column<double, 9>();
  check_column<float, 5>();
  check_column<float, 11>();
}

TEST_CASE("the leading registers of a column that hold an entry end where a register ends", "[kalman]") {
  constexpr int two = detail::register_width<double>(2);
  STATIC_REQUIRE(two == 2);
  STATIC_REQUIRE(detail::registers_through<double, 5>(4) == 5);
  STATIC_REQUIRE(detail::registers_through<double, 5>(0) == detail::register_width<double>(5));
  STATIC_REQUIRE_FALSE(detail::in_registers<long double>);
}

#endif
