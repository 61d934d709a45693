// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <scifi/kalman/joseph.hpp>

namespace scifi::kalman {

/// Update of a non-linear measurement by Gauss-Newton iteration (Bell and Cathey 1993, IEEE Trans. Autom. Control 38, 294, eq. 9-12).
///
/// The measurement is linearised about the last result and the base policy applied to the prior again, until no component moves by
/// more than `tolerance` of its standard deviation. Residual, S, H and chi2 are those of the last linearisation, seen from the prior;
/// chi2 is then the minimum of the cost. Fails with not_converged after `max_iterations`; a linear measurement needs one iteration.
template <class Base = joseph>
struct iterated {
  Base base{};
  int max_iterations = 10;
  double tolerance = 1.0e-6;

  template <class Scalar, int N, class Measurement>
  [[nodiscard]] auto operator()(const estimate<Scalar, N>& prior, const Measurement& m) const -> updated<Scalar, N, max_measurement_dimension<Measurement>> {
    if constexpr (detail::has_projection<Measurement>) {
      return base(prior, m);
    } else {
      vector<Scalar, N> about = prior.mean;
      const Scalar tolerance2 = Scalar(tolerance * tolerance);
      for (int i = 1;; ++i) {
        updated<Scalar, N, max_measurement_dimension<Measurement>> out = base(prior, linearise(m, about));
        if (!out.status.ok()) return out;
        Scalar excess(0.0);
        for (int c = 0; c < N; ++c) {
          const Scalar moved = out.posterior.mean(c) - about(c);
          const Scalar allowed = tolerance2 * out.posterior.covariance(c, c);
          excess = larger_of<Scalar>(excess, Scalar(moved * moved - allowed));
        }
        if (!any_of(excess > Scalar(0.0))) return out;
        if (i >= max_iterations) {
          out.posterior = prior;
          out.status.why = reason::not_converged;
          return out;
        }
        about = out.posterior.mean;
      }
    }
  }
};

iterated() -> iterated<joseph>;
template <class Base>
iterated(Base) -> iterated<Base>;
template <class Base>
iterated(Base, int) -> iterated<Base>;
template <class Base>
iterated(Base, int, double) -> iterated<Base>;

}  // namespace scifi::kalman
