// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <iterator>
#include <optional>
#include <type_traits>

#include <scifi/core/linalg.hpp>
#include <scifi/core/scalar.hpp>
#include <scifi/kalman/apply_gate.hpp>
#include <scifi/kalman/cholesky.hpp>
#include <scifi/kalman/filter.hpp>
#include <scifi/kalman/gain.hpp>
#include <scifi/kalman/measurement.hpp>
#include <scifi/kalman/status.hpp>

namespace scifi {

/// What measurements still to be made can say about the state a path starts from: their Fisher information, gathered step by step.
///
/// The start x0 is an unknown constant. Seen from it, the state at a site is f(x0) + w, where w (covariance W) is the process noise that the measurements so
/// far have not resolved. A measurement of Jacobian H and covariance R then adds, with B = d state/d x0 given those measurements,
///   J += (H B)' S^-1 (H B),  S = H W H' + R;  B -= K H B,  W -= K H W,  K = W H' S^-1,
/// and a step of Jacobian F and noise Q makes B = F B, W = F W F' + Q. This is A' C^-1 A of all measurements with C = R + correlated noise, in one pass: the
/// filter's innovations are independent (Kailath, IEEE Trans. Autom. Control 13 (1968) 646), and B is their sensitivity to x0 (Friedland, IEEE Trans. Autom.
/// Control 14 (1969) 359). Non-linear parts are taken at the noise-free flight of the start. How the noise itself depends on the start is left out: it
/// is a few per mille of what bent tracks know.
template <class Scalar, int N>
struct gathered_information {
  vector<Scalar, N> state;                                                ///< of the noise-free flight, where the path has come to
  matrix<Scalar, N, N> noise = matrix<Scalar, N, N>::Zero();              ///< W
  matrix<Scalar, N, N> sensitivity = matrix<Scalar, N, N>::Identity();    ///< B
  matrix<Scalar, N, N> information = matrix<Scalar, N, N>::Zero();        ///< J, of the start; inverse units of the state
  int measured = 0;                                                       ///< sum of the dimensions of the measurements
  kalman::status status{};                                                ///< of the step that ended the path, if one did: what was gathered before it stays

  /// Nothing gathered yet, at this start.
  explicit gathered_information(const vector<Scalar, N>& start) : state(start) {}

  /// Moves on by a step with the propagator and the noise of a `kalman::filter`; an empty optional step changes nothing.
  template <class Filter, class Step>
  void move(const Filter& filter, const Step& step) {
    if (!status.ok()) return;
    const auto p = filter.predict(kalman::estimate<Scalar, N>{state, noise}, step);
    status = p.status;
    if (!status.ok()) return;
    const matrix<Scalar, N, N> before = sensitivity;
    sensitivity.noalias() = p.jacobian.lazyProduct(before);
    state = p.estimate.mean;
    noise = p.estimate.covariance;
  }

  /// Takes in that a measurement will be made here. Its value is not looked at; it may be a std::optional or a std::variant.
  template <class Measurement>
  void measure(const Measurement& m) {
    if (!status.ok()) return;
    if constexpr (kalman::mixed_measurement<Measurement>) {
      kalman::detail::visit_measurement(m, [this](const auto& one) { this->measure(one); });
    } else if constexpr (!std::is_same_v<Measurement, kalman::no_measurement>) {
      constexpr int M = kalman::max_measurement_dimension<Measurement>;
      const kalman::innovation<Scalar, N, M> seen = kalman::compare(m, state);
      const kalman::gain<Scalar, N, M> k = kalman::optimal_gain(noise, seen);
      if (k.why != kalman::reason::none) {
        status = {kalman::step_kind::update, k.why};
        return;
      }
      const matrix<Scalar, M, N> by_start = seen.jacobian.lazyProduct(sensitivity);
      const kalman::cholesky<Scalar, M> factor(k.residual_covariance);
      const matrix<Scalar, M, N> white = factor.template half_solve<N>(by_start);
      information += white.transpose().lazyProduct(white);
      const matrix<Scalar, N, M> weight = k.weight();
      sensitivity -= weight.lazyProduct(by_start);
      noise -= weight.lazyProduct(k.cross.transpose());
      noise = symmetrised<Scalar, N>(noise);
      measured += M;
    }
  }
};

/// Fisher information that the sites of a path hold on the state it starts from, for the propagator and noise of a `kalman::filter`; sites as for
/// `filter::run`, values of measurements not looked at. Two paths that leave the same state in opposite directions have independent noise: their
/// informations add. Ends at the first step that fails (a particle that stops), with its status and what was gathered before.
template <class Filter, class Scalar, int N, class Sites>
[[nodiscard]] gathered_information<Scalar, N> fisher_information(const Filter& filter, const vector<Scalar, N>& start, const Sites& sites) {
  gathered_information<Scalar, N> out(start);
  for (const auto& site : sites) {
    out.move(filter, site.step);
    out.measure(site.measurement);
    if (!out.status.ok()) break;
  }
  return out;
}

/// The Cramer-Rao bound: no unbiased estimate of the state has a smaller covariance than the inverse of its Fisher information (Cramer, Mathematical Methods
/// of Statistics (1946) 32.3; Rao, Bull. Calcutta Math. Soc. 37 (1945) 81). Empty where the information is singular to working precision: the
/// measurements do not fix the state. Components may have units of any size.
template <class Scalar, int N>
[[nodiscard]] std::optional<matrix<Scalar, N, N>> cramer_rao_bound(const matrix<Scalar, N, N>& information) {
  using std::sqrt;
  vector<Scalar, N> unit;
  for (int i = 0; i < N; ++i) {
    const Scalar own(information(i, i));
    if (!(own > Scalar(0.0))) return std::nullopt;
    unit(i) = Scalar(1.0) / sqrt(own);
  }
  matrix<Scalar, N, N> scaled;
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < N; ++j) scaled(i, j) = information(i, j) * unit(i) * unit(j);
  const kalman::cholesky<Scalar, N> factor(scaled);
  if (!factor.ok()) return std::nullopt;
  const matrix<Scalar, N, N> inverse = factor.template solve<N>(matrix<Scalar, N, N>::Identity());
  matrix<Scalar, N, N> out;
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < N; ++j) out(i, j) = inverse(i, j) * unit(i) * unit(j);
  return symmetrised<Scalar, N>(out);
}

}  // namespace scifi
