// SPDX-License-Identifier: MPL-2.0
#include <scifi/kalman/structure.hpp>

#include <array>
#include <limits>
#include <random>

#include <scifi/kalman/joseph.hpp>
#include <scifi/kalman/symmetric_form.hpp>

#include "laws/structure_laws.hpp"
#include "support/catch.hpp"
#include "unit/kalman/models.hpp"

namespace kalman = scifi::kalman;

namespace {

struct says_nothing {};
struct says_two {
  static constexpr std::array unit_columns{0, 2};
  static constexpr std::array seen_components{1};
};
struct passes_on {
  static constexpr auto unit_columns = kalman::unit_columns<says_two>;
};

template <class Scalar, int N>
struct random_step {
  scifi::matrix<Scalar, N, N> f, q;
};
template <class Scalar, int N, int... Unit>
struct random_model {
  static constexpr std::array<int, sizeof...(Unit)> unit_columns{Unit...};
  const scifi::matrix<Scalar, N, N>& transition(const random_step<Scalar, N>& s) const { return s.f; }
  const scifi::matrix<Scalar, N, N>& covariance(const random_step<Scalar, N>& s) const { return s.q; }
};
template <class Scalar, int N, int M, int... Seen>
struct random_values {
  static constexpr std::array<int, sizeof...(Seen)> seen_components{Seen...};
  scifi::vector<Scalar, M> z;
  scifi::matrix<Scalar, M, N> h;
  scifi::matrix<Scalar, M, M> r;
  const scifi::vector<Scalar, M>& value() const { return z; }
  const scifi::matrix<Scalar, M, N>& projection() const { return h; }
  const scifi::matrix<Scalar, M, M>& covariance() const { return r; }
};

template <int... I>
using list = std::integer_sequence<int, I...>;

/// Models drawn at random that are what they declare, against themselves without a declaration.
template <class Scalar, int N, int M, int... Unit, int... Seen>
void check(list<Unit...>, list<Seen...>) {
  std::mt19937_64 engine(static_cast<unsigned>(1000 * N + 100 * M + 10 * static_cast<int>(sizeof...(Unit)) + static_cast<int>(sizeof...(Seen))));
  for (int trial = 0; trial < 20; ++trial) {
    random_step<Scalar, N> s{models::random_matrix<N, N>(engine).template cast<Scalar>(), models::random_covariance<N>(engine).template cast<Scalar>()};
    ((s.f.col(Unit) = scifi::vector<Scalar, N>::Unit(Unit)), ...);
    random_values<Scalar, N, M, Seen...> m{models::random_matrix<M, 1>(engine).template cast<Scalar>(), scifi::matrix<Scalar, M, N>::Zero(), models::random_covariance<M>(engine).template cast<Scalar>()};
    ((m.h.col(Seen) = models::random_matrix<M, 1>(engine).template cast<Scalar>()), ...);
    const random_model<Scalar, N, Unit...> model;
    const kalman::estimate<Scalar, N> start{models::random_matrix<N, 1>(engine).template cast<Scalar>(), models::random_covariance<N>(engine).template cast<Scalar>()};
    CHECK(laws::undeclared_columns(model, start.mean, s) == Scalar(0));
    // Rounding of sums of at most N^2 products; P and S of these draws have a condition of up to 10^3.
    const Scalar tolerance = Scalar(1.0e3) * Scalar(N * N) * std::numeric_limits<Scalar>::epsilon();
    CHECK(laws::declaration_dependence(kalman::symmetric_form{}, model, model, start, s, m) < tolerance);
    CHECK(laws::declaration_dependence(kalman::joseph{}, model, model, start, s, m) < tolerance);
  }
}

}  // namespace

TEST_CASE("what models declare of their matrices becomes bits, what they do not is dense", "[kalman]") {
  static_assert(kalman::detail::unit_columns_of<says_nothing>() == 0u);
  static_assert(kalman::detail::unit_columns_of<says_two>() == 0b101u);
  static_assert(kalman::detail::unit_columns_of<passes_on>() == 0b101u);
  static_assert(kalman::detail::seen_components_of<says_nothing>() == ~0u);
  static_assert(kalman::detail::seen_components_of<says_two>() == 0b10u);
  CHECK(kalman::detail::has_bit(0b100u, 2));
  CHECK_FALSE(kalman::detail::has_bit(0b100u, 1));
}

TEST_CASE("random models filter to the same estimate with what they declare and without", "[kalman]") {
  check<double, 1, 1>(list<0>{}, list<0>{});
  check<double, 2, 1>(list<0>{}, list<1>{});
  check<double, 3, 2>(list<1>{}, list<0, 2>{});
  check<double, 4, 1>(list<0, 1, 2, 3>{}, list<3>{});
  check<double, 5, 1>(list<0, 2>{}, list<0, 2>{});
  check<double, 5, 2>(list<4>{}, list<0, 1, 2, 3>{});
  check<double, 7, 3>(list<0, 3, 6>{}, list<1, 6>{});
  check<double, 9, 4>(list<8>{}, list<0, 8>{});
  check<float, 6, 2>(list<0, 5>{}, list<2, 3>{});
  check<long double, 5, 1>(list<0, 2>{}, list<0, 2>{});
}
