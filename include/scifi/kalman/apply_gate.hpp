// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <optional>
#include <type_traits>
#include <variant>

#include <scifi/kalman/measurement.hpp>
#include <scifi/kalman/updated.hpp>

namespace scifi::kalman::detail {

template <class T>
inline constexpr bool is_optional = false;
template <class T>
inline constexpr bool is_optional<std::optional<T>> = true;

/// Calls `f` with the measurement that a variant or an optional holds; with `no_measurement` where it holds none.
template <class M, class F>
[[nodiscard]] auto visit_measurement(const std::optional<M>& m, F&& f) {
  return m ? f(*m) : f(no_measurement{});
}
template <class... Ms, class F>
[[nodiscard]] auto visit_measurement(const std::variant<Ms...>& m, F&& f) {
  return std::visit(f, m);
}

/// The result of an update as one of run-time dimension.
template <class Result, class E, int M, int MaxM>
[[nodiscard]] Result mixed(const basic_updated<E, M, MaxM>& u) {
  return {u.posterior, u.residual, u.residual_covariance, u.jacobian, u.measurement_covariance, u.chi2, u.status, u.outlier};
}

/// Zeros in place of a comparison that was not made.
template <class E, int M>
void clear(basic_updated<E, M>& u) {
  u.residual.setZero();
  u.residual_covariance.setZero();
  u.jacobian.setZero();
  u.measurement_covariance.setZero();
}

/// b where the mask is false.
template <class Mask, class Derived>
void keep_where(const Mask& accepted, Eigen::MatrixBase<Derived>& a, const Eigen::MatrixBase<Derived>& b) {
  using Scalar = typename Derived::Scalar;
  for (Eigen::Index j = 0; j < a.cols(); ++j)
    for (Eigen::Index i = 0; i < a.rows(); ++i) a(i, j) = select(accepted, Scalar(a(i, j)), Scalar(b(i, j)));
}

template <class Mask, class Scalar, int N>
void keep_where(const Mask& accepted, estimate<Scalar, N>& a, const estimate<Scalar, N>& b) {
  keep_where(accepted, a.mean, b.mean);
  keep_where(accepted, a.covariance, b.covariance);
}

/// Asks the gate and moves the update to `out`, whose posterior is the prior; a rejected measurement leaves it there.
template <class Gate, class E, int M>
void apply_gate(const Gate& gate, const basic_updated<E, M>& u, basic_updated<E, M>& out) {
  const E before = out.posterior;
  out = u;
  if (!u.status.ok()) return;
  const auto accepted = gate(u.chi2, M);
  if constexpr (std::is_same_v<std::remove_cvref_t<decltype(accepted)>, bool>) {
    if (!accepted) {
      out.posterior = before;
      const typename E::scalar zero(0.0);
      out.outlier = zero <= zero;  // in every lane
    }
  } else {
    keep_where(accepted, out.posterior, before);
    out.outlier = !accepted;
  }
}

}  // namespace scifi::kalman::detail
