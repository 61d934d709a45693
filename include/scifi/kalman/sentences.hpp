// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <scifi/kalman/concepts.hpp>

/// What the compiler says when a part does not fit: one sentence each, chosen by asking the questions in the order a reader would.
namespace scifi::kalman::detail {

template <class Prior>
struct prior_fits {
  static constexpr bool value = prior<Prior>;
  static_assert(value, "scifi: predict, update and run need an estimate, or the result of a predict or an update, as their first argument");
};

template <class P, class Scalar, int N, class Step>
struct propagator_fits {
  static constexpr bool value = propagator<P, Scalar, N, Step>;
  static constexpr bool general = has_propagate<P, Scalar, N, Step>;
  static constexpr bool linear = !general && has_transition<P, Step>;
  static_assert(value || general || linear, "scifi: the propagator has neither a const transition(step) nor a const propagate(x, step) for this state and step");
  static_assert(value || !linear, "scifi: the propagator's transition(step) must be a fixed-size N x N matrix, where N is the size of the state");
  static constexpr bool members = [] {
    if constexpr (general) return requires(const P& p, const vector<Scalar, N>& x, const Step& s) { p.propagate(x, s).state; p.propagate(x, s).jacobian; };
    else return true;
  }();
  static_assert(value || members, "scifi: the propagator's propagate(x, step) must return a state and a jacobian, as propagated{state, jacobian} does");
  static_assert(value || !general || !members, "scifi: the propagator's Jacobian must be N x N and its state N long, fixed-size, where N is the size of the state");
};

template <class Q, class Scalar, int N, class Step>
struct noise_fits {
  static constexpr bool value = process_noise<Q, Scalar, N, Step>;
  static constexpr bool callable = has_noise_covariance<Q, Scalar, N, Step>;
  static_assert(value || callable, "scifi: the process noise has no const covariance(step), covariance(start, step) or covariance(start, step, moved)");
  static_assert(value || !callable, "scifi: the process noise's covariance must be a fixed-size N x N matrix, where N is the size of the state");
};

template <class Z, class Scalar, int N>
struct measurement_fits {
  static constexpr bool value = measurement<Z, Scalar, N>;
  static constexpr int M = max_measurement_dimension<Z>;
  static constexpr bool measured = has_value<Z>;
  static_assert(value || measured, "scifi: the measurement has no const value()");
  static constexpr bool column = [] {
    if constexpr (measured) return M > 0 && cols_of<decltype(std::declval<const Z&>().value())>() == 1;
    else return true;
  }();
  static_assert(value || column, "scifi: the measurement's value() must be a number or a fixed-size column vector");
  static constexpr bool known = has_covariance<Z>;
  static_assert(value || !measured || known, "scifi: the measurement has no const covariance()");
  static constexpr bool square = [] {
    if constexpr (measured && known && column) return shaped<decltype(std::declval<const Z&>().covariance()), M, M>;
    else return true;
  }();
  static_assert(value || square, "scifi: the measurement's covariance() must be M x M, where M is the size of its value()");
  static constexpr bool linear = has_projection<Z>;
  static constexpr bool general = has_project<Z, Scalar, N>;
  static_assert(value || linear || general, "scifi: the measurement has neither a const projection() nor a const project(x) for this state");
  static constexpr bool fits_state = [] {
    if constexpr (linear && measured && column) return shaped<decltype(std::declval<const Z&>().projection()), M, N>;
    else return true;
  }();
  static_assert(value || fits_state, "scifi: the measurement's projection() must be M x N: a row for each measured value, a column for each component of the state");
  static_assert(value || linear || !general || !measured || !known || !column || !square,
                "scifi: the measurement's project(x) must return a value of size M and a jacobian of M x N, as projected{value, jacobian} does");
};

template <class U, class Estimate, class Z>
struct update_fits {
  static constexpr bool value = update_policy<U, Estimate, Z>;
  static constexpr bool callable = requires(const U& u, const Estimate& e, const Z& z) { u(e, z); };
  static constexpr bool is_factored = !requires(const Estimate& e) { e.covariance(0, 0); };
  static_assert(value || callable || is_factored, "scifi: the update policy has no const operator()(estimate, measurement)");
  static_assert(value || callable || !is_factored, "scifi: the update policy does not take a factored estimate; square_root does");
  static_assert(value || !callable, "scifi: the update policy must return updated<Scalar, N, M>");
};

template <class G, class Scalar>
struct gate_fits {
  static constexpr bool value = gate<G, Scalar>;
  static_assert(value, "scifi: the gate has no const operator()(chi2, measurement_dimension) that says true or false");
};

template <class A, class B>
struct model_spaces_agree {
  static constexpr bool value = same_state_space<A, B>;
  static_assert(value, "scifi: the propagator and the process noise declare different state spaces");
};

template <class A, class B>
struct measurement_space_agrees {
  static constexpr bool value = same_state_space<A, B>;
  static_assert(value, "scifi: the measurement and the propagator declare different state spaces");
};

}  // namespace scifi::kalman::detail
