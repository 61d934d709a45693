// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <concepts>
#include <optional>
#include <type_traits>
#include <utility>
#include <variant>

#include <scifi/core/linalg.hpp>
#include <scifi/kalman/estimate.hpp>
#include <scifi/kalman/product.hpp>
#include <scifi/kalman/shape.hpp>

namespace scifi::kalman {

/// A step with no measurement: the update leaves the estimate as it is, adds nothing to chi2 and counts no degree of freedom.
struct no_measurement {};

namespace detail {

template <class M>
concept has_value = requires(const M& m) { m.value(); };
template <class M>
concept has_covariance = requires(const M& m) { m.covariance(); };
template <class M>
concept has_projection = requires(const M& m) { m.projection(); };
template <class M, class Scalar, int N>
concept has_project = requires(const M& m, const vector<Scalar, N>& x) { m.project(x); };

template <class M>
struct measurement_size {
  static constexpr bool mixed = false;
  static constexpr int value = [] {
    if constexpr (has_value<M>) return rows_of<decltype(std::declval<const M&>().value())>();
    else return 1;
  }();
};
template <>
struct measurement_size<no_measurement> {
  static constexpr bool mixed = false;
  static constexpr int value = 0;
};
template <class M>
struct measurement_size<std::optional<M>> {
  static constexpr bool mixed = true;
  static constexpr int value = std::max(1, measurement_size<M>::value);
};
template <class... Ms>
struct measurement_size<std::variant<Ms...>> {
  static constexpr bool mixed = true;
  static constexpr int value = std::max({1, measurement_size<Ms>::value...});
};

}  // namespace detail

/// Largest dimension that a measurement, an optional or a variant of measurements can have; 0 for `no_measurement`.
template <class Measurement>
inline constexpr int max_measurement_dimension = detail::measurement_size<Measurement>::value;

/// True where the dimension is known only at run time: std::variant and std::optional of measurements.
template <class Measurement>
inline constexpr bool mixed_measurement = detail::measurement_size<Measurement>::mixed;

/// A measurement seen from a state: what an update policy starts from.
template <class Scalar, int N, int M>
struct innovation {
  /// Measured minus expected.
  vector<Scalar, M> residual;
  /// H, d expected / d state.
  matrix<Scalar, M, N> jacobian;
  /// R, covariance of the measurement.
  matrix<Scalar, M, M> covariance;
};

namespace detail {

/// An innovation of parts that stand elsewhere.
template <class Scalar, int N, int M>
struct innovation_view {
  const vector<Scalar, M>& residual;
  const matrix<Scalar, M, N>& jacobian;
  const matrix<Scalar, M, M>& covariance;
};

/// use(innovation_view) of a measurement seen from x: H and R are not copied where the measurement keeps them.
template <class Scalar, int N, class Measurement, class Use>
[[gnu::always_inline]] inline auto with_innovation(const Measurement& m, const vector<Scalar, N>& x, const Use& use) {
  constexpr int M = max_measurement_dimension<Measurement>;
  const vector<Scalar, M>& value = converted<Scalar, M, 1>([&m]() -> decltype(auto) { return m.value(); });
  const auto against = [&](const vector<Scalar, M>& expected) -> vector<Scalar, M> {
    if constexpr (requires { m.residual(value, expected); }) return as_matrix<Scalar, M, 1>(m.residual(value, expected));
    else if constexpr (M == 1 && requires { m.residual(value(0), expected(0)); }) return as_matrix<Scalar, M, 1>(m.residual(value(0), expected(0)));
    else return value - expected;
  };
  const matrix<Scalar, M, M>& r = converted<Scalar, M, M>([&m]() -> decltype(auto) { return m.covariance(); });
  if constexpr (has_projection<Measurement>) {
    const matrix<Scalar, M, N>& h = converted<Scalar, M, N>([&m]() -> decltype(auto) { return m.projection(); });
    const vector<Scalar, M> residual = against(times_vector<Scalar, M, N, seen_components_of<Measurement>()>(h, x));
    return use(innovation_view<Scalar, N, M>{residual, h, r});
  } else {
    const auto expected = m.project(x);
    const matrix<Scalar, M, N>& h = converted<Scalar, M, N>([&expected]() -> decltype((expected.jacobian)) { return expected.jacobian; });
    const vector<Scalar, M> residual = against(as_matrix<Scalar, M, 1>(expected.value));
    return use(innovation_view<Scalar, N, M>{residual, h, r});
  }
}

}  // namespace detail

/// Compares a measurement with the state x: residual value - h(x), or m.residual(value, h(x)) where the measurement defines it.
template <class Measurement, class Scalar, int N>
[[nodiscard]] auto compare(const Measurement& m, const vector<Scalar, N>& x) -> innovation<Scalar, N, max_measurement_dimension<Measurement>> {
  using result = innovation<Scalar, N, max_measurement_dimension<Measurement>>;
  return detail::with_innovation(m, x, [](const auto& seen) -> result { return {seen.residual, seen.jacobian, seen.covariance}; });
}

/// A measurement replaced by its tangent at a state: itself a linear measurement, so that every update policy takes it.
template <class Scalar, int N, int M>
struct linear_measurement {
  vector<Scalar, M> z;
  matrix<Scalar, M, N> h;
  matrix<Scalar, M, M> r;

  [[nodiscard]] const vector<Scalar, M>& value() const { return z; }
  [[nodiscard]] const matrix<Scalar, M, N>& projection() const { return h; }
  [[nodiscard]] const matrix<Scalar, M, M>& covariance() const { return r; }
};

namespace detail {

/// True where a measurement is linear and its residual a plain difference, so that its tangent is itself wherever it is taken.
template <class Measurement, class Scalar, int N>
inline constexpr bool is_own_tangent = has_projection<Measurement> && !requires(const Measurement& m, const vector<Scalar, max_measurement_dimension<Measurement>>& v) {
  m.residual(v, v);
} && !requires(const Measurement& m, const Scalar& v) { m.residual(v, v); };

}  // namespace detail

/// Tangent of a measurement at `about`: its residual at x is the residual at `about` minus H (x - about).
template <class Measurement, class Scalar, int N>
[[nodiscard]] auto linearise(const Measurement& m, const vector<Scalar, N>& about) -> linear_measurement<Scalar, N, max_measurement_dimension<Measurement>> {
  constexpr int M = max_measurement_dimension<Measurement>;
  const innovation<Scalar, N, M> at = compare(m, about);
  const vector<Scalar, M> z = at.residual + at.jacobian.lazyProduct(about);
  return {z, at.jacobian, at.covariance};
}

}  // namespace scifi::kalman
