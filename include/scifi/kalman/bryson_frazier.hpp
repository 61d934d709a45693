// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstddef>
#include <span>

#include <scifi/kalman/ldl.hpp>
#include <scifi/kalman/node.hpp>
#include <scifi/kalman/node_view.hpp>
#include <scifi/kalman/symmetric.hpp>

namespace scifi::kalman {

namespace detail {

/// What later measurements say about a state: gradient and curvature of half the chi2 that the filter finds in them, by the mean it sets out from.
/// The smoothed estimate has the mean x - P gradient and the covariance P - P curvature P.
template <class Scalar, int N>
struct adjoint {
  vector<Scalar, N> gradient;
  matrix<Scalar, N, N> curvature;

  /// From the end of a step F, without a measurement there, to its start: F' g, F' L F.
  [[gnu::always_inline]] void pass_step(const matrix<Scalar, N, N>& f) { carry(f, matrix<Scalar, N, N>::Zero(), vector<Scalar, N>::Zero()); }

  /// From after a measurement at the end of a step F to the start of the step: A' g - F' H' S^-1 r and A' L A + F' H' S^-1 H F with A = (I - K H) F.
  /// Not multiplied out: where the measurement is far more precise than the prediction A is small, and L must not be a difference of large terms.
  template <int M>
  [[gnu::always_inline]] void pass_measurement_and_step(const matrix<Scalar, N, N>& predicted, const measured_view<Scalar, N, M>& seen, const matrix<Scalar, N, N>& f) {
    matrix<Scalar, M, M> inverse = ldl<Scalar, M>(seen.residual_covariance).template solve_from_right<M>(matrix<Scalar, M, M>::Identity());
    for (int j = 0; j < M; ++j)
      for (int i = 0; i < M; ++i) inverse(i, j) = select(seen.outlier, Scalar(0.0), Scalar(inverse(i, j)));
    const matrix<Scalar, N, M> weight = times<Scalar, N, M, M>(times_transposed<Scalar, N, N, M>(predicted, seen.jacobian), inverse);
    const matrix<Scalar, M, N> hf = times<Scalar, M, N, N>(seen.jacobian, f);
    matrix<Scalar, N, N> a;
    set_difference(a, f, weight, [&hf](int k, int j) -> const Scalar& { return hf(k, j); });
    const matrix<Scalar, N, M> fh = transposed<Scalar, M, N>(hf);
    const matrix<Scalar, N, M> scaled = times<Scalar, N, M, M>(fh, inverse);
    matrix<Scalar, N, N> added;
    multiply(added, scaled, transpose_of<Scalar, N, M>(fh));
    carry(a, added, -times_vector<Scalar, N, M>(scaled, seen.residual));
  }

  /// A' g + added_gradient, A' L A + added.
  [[gnu::always_inline]] void carry(const matrix<Scalar, N, N>& a, const matrix<Scalar, N, N>& added, const vector<Scalar, N>& added_gradient) {
    const matrix<Scalar, N, N> a_transposed = transposed<Scalar, N, N>(a);
    const matrix<Scalar, N, N> la = times<Scalar, N, N, N>(curvature, a);
    set_symmetric_sum(curvature, added, a_transposed, [&la](int k, int j) -> const Scalar& { return la(k, j); });
    const vector<Scalar, N> g = gradient;
    gradient = added_gradient + times_vector<Scalar, N, N>(a_transposed, g);
  }

  /// The estimate of the same state with what is known here taken in.
  void smooth(const estimate<Scalar, N>& known, estimate<Scalar, N>& smoothed) const {
    smoothed.mean = known.mean - times_vector<Scalar, N, N>(known.covariance, gradient);
    const matrix<Scalar, N, N> pl = times<Scalar, N, N, N>(known.covariance, curvature);
    set_symmetric_difference(smoothed.covariance, known.covariance, pl, transpose_of<Scalar, N, N>(known.covariance));
  }
};

}  // namespace detail

/// The modified Bryson-Frazier smoother: RTS without an inverse of P; a scalar measurement costs one division (Bierman, Fixed interval
/// smoothing with discrete measurements, Int. J. Control 18 (1973) 65).
///
/// P_s = P - P L P is a difference: where smoothing shrinks a variance to a part of its filtered value below eps x 10^4 or so, use `rauch_tung_striebel`.
struct modified_bryson_frazier {
  /// Sets `smoothed` of all nodes. `start`, where given, is replaced by the smoothed estimate at the start of the first step.
  template <class Scalar, int N, int MaxM>
  [[nodiscard]] status operator()(std::span<node<Scalar, N, MaxM>> nodes, estimate<Scalar, N>* start = nullptr) const {
    detail::adjoint<Scalar, N> later{vector<Scalar, N>::Zero(), matrix<Scalar, N, N>::Zero()};
    for (std::size_t k = nodes.size(); k-- > 0;) {
      node<Scalar, N, MaxM>& here = nodes[k];
      if (!here.status.ok()) return here.status;
      if (k + 1 == nodes.size()) {
        here.smoothed = here.filtered;
      } else {
        later.smooth(here.filtered, here.smoothed);
        const reason why = fault_of(here.smoothed.mean, here.smoothed.covariance);
        if (why != reason::none) return here.status = {step_kind::smooth, why};
      }
      if (k == 0 && start == nullptr) break;
      if (here.measurement_dimension == 0) later.pass_step(here.jacobian);
      else detail::with_measurement(here, [&](const auto& seen) { later.pass_measurement_and_step(here.predicted.covariance, seen, here.jacobian); });
    }
    if (start != nullptr) {
      const estimate<Scalar, N> before = *start;
      later.smooth(before, *start);
    }
    return {step_kind::smooth, reason::none};
  }
};

}  // namespace scifi::kalman
