// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <concepts>
#include <type_traits>

#include <Eigen/Core>
#include <unsupported/Eigen/AutoDiff>

#include <scifi/kalman/concepts.hpp>

namespace scifi::kalman {

namespace detail {

template <class Scalar, int N>
using dual_number = Eigen::AutoDiffScalar<vector<Scalar, N>>;

/// x with its derivatives by its own components.
template <class Scalar, int N>
[[nodiscard]] vector<dual_number<Scalar, N>, N> as_dual(const vector<Scalar, N>& x) {
  vector<dual_number<Scalar, N>, N> out;
  for (int i = 0; i < N; ++i) out(i) = dual_number<Scalar, N>(x(i), N, i);
  return out;
}

/// True where T is a dual number of N derivatives, an expression of such, or a matrix of them: not of a function that takes double alone.
template <class T, class Scalar, int N>
inline constexpr bool is_dual = [] {
  if constexpr (eigen_like<T>) return std::is_same_v<typename T::Scalar, dual_number<Scalar, N>>;
  else return std::is_convertible_v<T, dual_number<Scalar, N>> && !std::is_convertible_v<T, Scalar>;
}();

/// Values of dual numbers to `value`, their derivatives to the rows of `jacobian`.
template <class Duals, class Value, class Jacobian>
void take_apart(const Duals& from, Value& value, Jacobian& jacobian) {
  for (Eigen::Index i = 0; i < from.size(); ++i) {
    value(i) = from(i).value();
    jacobian.row(i) = from(i).derivatives().transpose();
  }
}

}  // namespace detail

/// A propagator made from a callable f(x, step) that returns the state at the end, templated on the scalar of x.
///
/// The Jacobian comes from dual numbers (forward differentiation, exact to rounding), at the cost of N + 1 evaluations.
/// f must find its functions by argument-dependent lookup: `using std::sqrt; sqrt(x)`.
template <class Function>
struct automatic_jacobian {
  Function f;

  template <class Scalar, int N, class Step>
    requires std::invocable<const Function&, const vector<Eigen::AutoDiffScalar<vector<Scalar, N>>, N>&, const Step&>
  [[nodiscard]] propagated<Scalar, N> propagate(const vector<Scalar, N>& x, const Step& step) const {
    using dual = detail::dual_number<Scalar, N>;
    constexpr bool any_scalar = detail::is_dual<std::remove_cvref_t<std::invoke_result_t<const Function&, const vector<dual, N>&, const Step&>>, Scalar, N>;
    static_assert(any_scalar, "scifi: the function of automatic_jacobian must be a template that takes a vector of any scalar and returns one of the same");
    propagated<Scalar, N> out;
    if constexpr (any_scalar) {
      const vector<dual, N> end = f(detail::as_dual(x), step);
      detail::take_apart(end, out.state, out.jacobian);
    }
    return out;
  }
};

template <class Function>
automatic_jacobian(Function) -> automatic_jacobian<Function>;

/// A measurement made from one that has, in place of project(x), a const expected(x): the expected value, a number or a vector, templated on the scalar of x.
///
/// Its value(), covariance() and residual(value, expected), where it has one, are used as they are; the Jacobian comes as that of `automatic_jacobian`.
template <class Measurement>
struct automatic_projection {
  Measurement measured;

  [[nodiscard]] decltype(auto) value() const { return measured.value(); }
  [[nodiscard]] decltype(auto) covariance() const { return measured.covariance(); }

  template <class Value, class Expected>
    requires requires(const Measurement& m, const Value& v, const Expected& e) { m.residual(v, e); }
  [[nodiscard]] auto residual(const Value& v, const Expected& e) const {
    return measured.residual(v, e);
  }

  template <class Scalar, int N>
  [[nodiscard]] auto project(const vector<Scalar, N>& x) const -> projected<Scalar, max_measurement_dimension<Measurement>, N> {
    constexpr int M = max_measurement_dimension<Measurement>;
    using dual = detail::dual_number<Scalar, N>;
    constexpr bool any_scalar = [] {
      if constexpr (requires(const Measurement& m, const vector<dual, N>& start) { m.expected(start); })
        return detail::is_dual<std::remove_cvref_t<decltype(std::declval<const Measurement&>().expected(std::declval<const vector<dual, N>&>()))>, Scalar, N>;
      else return false;
    }();
    static_assert(any_scalar, "scifi: the measurement of automatic_projection needs a const expected(x), a template that takes a state of any scalar and returns the same scalar");
    projected<Scalar, M, N> out;
    if constexpr (any_scalar) {
      const vector<dual, M> end = detail::as_matrix<dual, M, 1>(measured.expected(detail::as_dual(x)));
      detail::take_apart(end, out.value, out.jacobian);
    }
    return out;
  }
};

template <class Measurement>
automatic_projection(Measurement) -> automatic_projection<Measurement>;

namespace detail {

template <class Function>
struct state_space_of<automatic_jacobian<Function>> : state_space_of<Function> {};
template <class Measurement>
struct state_space_of<automatic_projection<Measurement>> : state_space_of<Measurement> {};

}  // namespace detail

}  // namespace scifi::kalman
