// SPDX-License-Identifier: MPL-2.0
#include <scifi/core/planar.hpp>

#include <cmath>
#include <complex>
#include <limits>

#include "support/catch.hpp"

using scifi::planar;

namespace {

template <class T>
void check_against_complex(T tolerance) {
  const planar<T> a{T(1.5), T(-0.25)}, b{T(-0.7), T(2.1)};
  const std::complex<T> ca(a.x, a.y), cb(b.x, b.y);
  const auto same = [tolerance](const planar<T>& p, const std::complex<T>& c) { return std::abs(std::complex<T>(p.x, p.y) - c) <= tolerance * std::abs(c); };
  CHECK(same(a + b, ca + cb));
  CHECK(same(a - b, ca - cb));
  CHECK(same(a * b, ca * cb));
  CHECK(same(T(3.0) * a, T(3.0) * ca));
  CHECK(same(conjugate(a), std::conj(ca)));
  CHECK(std::abs(norm(a) - std::norm(ca)) <= tolerance * std::norm(ca));
  CHECK(std::abs(dot(a, b) - (std::conj(ca) * cb).real()) <= tolerance * std::abs(ca) * std::abs(cb));
  planar<T> sum = a;
  sum += b;
  CHECK(same(sum, ca + cb));
  sum -= a;
  CHECK(same(sum, cb));
}

}  // namespace

TEST_CASE("planar vectors calculate as complex numbers do", "[core]") {
  check_against_complex<double>(8.0 * std::numeric_limits<double>::epsilon());
  check_against_complex<float>(8.0f * std::numeric_limits<float>::epsilon());
}

TEST_CASE("multiplying by a unit vector turns and keeps the length", "[core]") {
  const planar<double> a{3.0, 4.0};
  const planar<double> quarter{0.0, 1.0};
  const planar<double> turned = quarter * a;
  CHECK(turned.x == -4.0);
  CHECK(turned.y == 3.0);
  CHECK(norm(turned) == 25.0);
  CHECK(dot(a, turned) == 0.0);
}

TEST_CASE("planar vectors work at compile time", "[core]") {
  static_assert((planar<double>{1.0, 2.0} * planar<double>{3.0, -1.0}).x == 5.0);
  static_assert(norm(planar<double>{3.0, 4.0}) == 25.0);
  SUCCEED();
}
