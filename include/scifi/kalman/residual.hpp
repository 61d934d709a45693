// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <limits>

#include <scifi/kalman/cholesky.hpp>
#include <scifi/kalman/measurement.hpp>
#include <scifi/kalman/symmetric.hpp>
#include <scifi/kalman/updated.hpp>

namespace scifi::kalman {

/// Measured minus expected, with the covariance of that difference, of M dimensions (Eigen::Dynamic up to MaxM).
template <class Scalar, int M, int MaxM = M>
struct residual {
  bounded_matrix<Scalar, M, 1, MaxM, 1> value;
  bounded_matrix<Scalar, M, M, MaxM, MaxM> covariance;
};

/// One component over its standard deviation: standard normal where the model is right; NaN where the variance is negative.
template <class Scalar, int M, int MaxM>
[[nodiscard]] Scalar pull(const residual<Scalar, M, MaxM>& r, int component = 0) {
  const Scalar value(r.value(component));
  return value / sigma_of_variance<Scalar>(r.covariance(component, component));
}

/// The pull of a measurement against what was known before it, as an update saw it: one component of the residual over the root of its variance.
template <class Estimate, int M, int MaxM>
[[nodiscard]] typename Estimate::scalar pull(const basic_updated<Estimate, M, MaxM>& u, int component = 0) {
  using Scalar = typename Estimate::scalar;
  return Scalar(u.residual(component)) / sigma_of_variance<Scalar>(u.residual_covariance(component, component));
}

namespace detail {

/// Replaces `b` by C^-1 b, or by L^-1 b with C = L L' where `half`; NaN where C is not positive definite. Any size, in place.
template <class Covariance, class B>
void solve_in_place(Covariance c, B& b, bool half) {
  using std::sqrt;
  using Scalar = typename Covariance::Scalar;
  const Eigen::Index n = c.rows();
  for (Eigen::Index j = 0; j < n; ++j) {
    for (Eigen::Index k = 0; k < j; ++k) c(j, j) -= c(j, k) * c(j, k);
    const auto positive = c(j, j) > Scalar(0.0);
    const Scalar root = sqrt(select(positive, Scalar(c(j, j)), Scalar(1.0)));
    c(j, j) = select(positive, root, Scalar(std::numeric_limits<double>::quiet_NaN()));
    for (Eigen::Index i = j + 1; i < n; ++i) {
      for (Eigen::Index k = 0; k < j; ++k) c(i, j) -= c(i, k) * c(j, k);
      c(i, j) /= c(j, j);
    }
  }
  for (Eigen::Index col = 0; col < b.cols(); ++col) {
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index k = 0; k < i; ++k) b(i, col) -= c(i, k) * b(k, col);
      b(i, col) /= c(i, i);
    }
    for (Eigen::Index i = n; !half && i-- > 0;) {
      for (Eigen::Index k = i + 1; k < n; ++k) b(i, col) -= c(k, i) * b(k, col);
      b(i, col) /= c(i, i);
    }
  }
}

}  // namespace detail

/// L^-1 value with covariance L L': uncorrelated components of unit variance; NaN where the covariance is not positive definite.
template <class Scalar, int M, int MaxM>
[[nodiscard]] auto whitened(const residual<Scalar, M, MaxM>& r) {
  bounded_matrix<Scalar, M, 1, MaxM, 1> white = r.value;
  detail::solve_in_place(r.covariance, white, true);
  return white;
}

/// value' covariance^-1 value.
template <class Scalar, int M, int MaxM>
[[nodiscard]] Scalar chi2(const residual<Scalar, M, MaxM>& r) {
  const auto white = whitened(r);
  Scalar sum(0.0);
  for (Eigen::Index i = 0; i < white.size(); ++i) sum += white(i) * white(i);
  return sum;
}

/// Residual of a measurement that the estimate does not contain: covariance R + H P H'.
template <class Scalar, int N, class Measurement>
[[nodiscard]] auto residual_if_unused(const estimate<Scalar, N>& e, const Measurement& m) -> residual<Scalar, max_measurement_dimension<Measurement>> {
  const auto seen = compare(m, e.mean);
  return {seen.residual, seen.covariance + seen.jacobian.lazyProduct(e.covariance).eval().lazyProduct(seen.jacobian.transpose())};
}

/// Residual of a measurement that the estimate contains: covariance R - H P H'.
template <class Scalar, int N, class Measurement>
[[nodiscard]] auto residual_if_used(const estimate<Scalar, N>& e, const Measurement& m) -> residual<Scalar, max_measurement_dimension<Measurement>> {
  const auto seen = compare(m, e.mean);
  return {seen.residual, seen.covariance - seen.jacobian.lazyProduct(e.covariance).eval().lazyProduct(seen.jacobian.transpose())};
}

/// The residual with the measurement taken out of the estimate that contains it: value R D^-1 r, covariance R D^-1 R, D = R - H P H'.
///
/// The inverse update of Fruehwirth 1987 (NIM A 262, 444, eq. 10) carried through to the residual; NaN where D is not positive definite.
template <class Scalar, int M, int MaxM, class Noise>
[[nodiscard]] residual<Scalar, M, MaxM> without_own_measurement(const residual<Scalar, M, MaxM>& used, const Noise& measurement_covariance) {
  residual<Scalar, M, MaxM> out{used.value, measurement_covariance};
  detail::solve_in_place(used.covariance, out.value, false);
  detail::solve_in_place(used.covariance, out.covariance, false);
  const bounded_matrix<Scalar, M, 1, MaxM, 1> d_r = out.value;
  const bounded_matrix<Scalar, M, M, MaxM, MaxM> d_noise = out.covariance;
  out.value.noalias() = measurement_covariance.lazyProduct(d_r);
  out.covariance.noalias() = measurement_covariance.lazyProduct(d_noise);
  return out;
}

/// The estimate with a measurement that it contains taken out again (inverse update, Fruehwirth 1987, eq. 10).
///
/// Gain -P H' D^-1 with D = R - H P H'; fails with singular_innovation where D is not positive definite: the rest does not fix the state.
template <class Scalar, int N, class Measurement>
[[nodiscard]] auto removed(const estimate<Scalar, N>& e, const Measurement& m) -> updated<Scalar, N, max_measurement_dimension<Measurement>> {
  constexpr int M = max_measurement_dimension<Measurement>;
  const innovation<Scalar, N, M> seen = compare(m, e.mean);
  const residual<Scalar, M> used = residual_if_used(e, m);
  updated<Scalar, N, M> out{e, seen.residual, used.covariance, seen.jacobian, seen.covariance, chi2(used), {step_kind::update, reason::none}, {}};
  const cholesky<Scalar, M> factor(used.covariance);
  if (!any_of(factor.ok())) {
    out.status.why = reason::singular_innovation;
    return out;
  }
  const matrix<Scalar, N, M> cross = e.covariance.lazyProduct(seen.jacobian.transpose());
  const matrix<Scalar, N, M> weight = detail::transposed<Scalar, M, N>(factor.template solve<N>(detail::transposed<Scalar, N, M>(cross)));
  out.posterior = {e.mean - weight.lazyProduct(seen.residual), detail::symmetric_sum<Scalar, N, M>(e.covariance, weight, cross)};
  out.status.why = fault_of(out.posterior.mean, out.posterior.covariance);
  if (!out.status.ok()) out.posterior = e;
  return out;
}

}  // namespace scifi::kalman
