// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <functional>
#include <optional>
#include <type_traits>
#include <variant>

#include <scifi/kalman/gate.hpp>
#include <scifi/kalman/measurement.hpp>
#include <scifi/kalman/updated.hpp>

namespace scifi::kalman::detail {

template <class T>
inline constexpr bool is_optional = false;
template <class T>
inline constexpr bool is_optional<std::optional<T>> = true;

template <class T>
inline constexpr bool is_reference = false;
template <class T>
inline constexpr bool is_reference<std::reference_wrapper<T>> = true;

/// Calls `f` with the measurement that a variant or an optional holds; with `no_measurement` where it holds none.
template <class M, class F>
[[gnu::always_inline]] inline auto visit_measurement(const std::optional<M>& m, F&& f) {
  return m ? f(*m) : f(no_measurement{});
}
template <class... Ms, class F>
[[nodiscard]] auto visit_measurement(const std::variant<Ms...>& m, F&& f) {
  return std::visit(f, m);
}

/// Calls `f` with the measurement that is there in the end, however variants and optionals are nested; with `no_measurement` where there is none.
template <class Measurement, class F>
[[gnu::always_inline]] inline void each_alternative(const Measurement& m, const F& f) {
  if constexpr (mixed_measurement<Measurement>) visit_measurement(m, [&f](const auto& one) __attribute__((always_inline)) { each_alternative(one, f); });
  else f(m);
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

/// Asks the gate about an update that was made; where it rejects the measurement the prior is put back and the update marked.
template <int M, class Gate, class E, class Outcome>
void apply_gate(const Gate& gate, const E& prior, E& posterior, Outcome& u) {
  if constexpr (!std::is_same_v<Gate, no_gate>) {
    if (!u.status.ok()) return;
    const auto accepted = gate(u.chi2, M);
    if constexpr (std::is_same_v<std::remove_cvref_t<decltype(accepted)>, bool>) {
      if (!accepted) {
        posterior = prior;
        u.outlier = mask<typename E::scalar>(true);
      }
    } else {
      keep_where(accepted, posterior, prior);
      u.outlier = !accepted;
    }
  }
}

}  // namespace scifi::kalman::detail
