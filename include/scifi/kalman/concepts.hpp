// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <concepts>
#include <type_traits>

#include <scifi/kalman/measurement.hpp>
#include <scifi/kalman/process_noise.hpp>
#include <scifi/kalman/propagation.hpp>
#include <scifi/kalman/updated.hpp>

/// Everything a filter is made of, and the law each part obeys. All parts are const: one object serves any number of threads.
/// A part may declare `using state_space = X;` parts that declare one must agree.
namespace scifi::kalman {

namespace detail {

template <class T>
struct state_space_of {
  using type = void;
};
template <class T>
  requires requires { typename T::state_space; }
struct state_space_of<T> {
  using type = typename T::state_space;
};

/// True unless both declare a state space and they differ.
template <class A, class B>
inline constexpr bool same_state_space = std::is_void_v<typename state_space_of<A>::type> || std::is_void_v<typename state_space_of<B>::type> ||
                                         std::is_same_v<typename state_space_of<A>::type, typename state_space_of<B>::type>;

}  // namespace detail

/// p.transition(step) gives F, N x N.
/// Law: the state after the step is F x; a step of no length gives the identity; two steps after one another give the product.
template <class P, class Scalar, int N, class Step>
concept linear_propagator = requires(const P& p, const Step& step) {
  { p.transition(step) } -> detail::shaped<N, N>;
};

/// p.propagate(x, step) gives {state, jacobian}.
/// Law: jacobian is the derivative of state by x; a step and its reverse cancel; the path may be cut into steps anywhere.
template <class P, class Scalar, int N, class Step>
concept general_propagator = requires(const P& p, const vector<Scalar, N>& x, const Step& step) {
  { p.propagate(x, step).state } -> detail::shaped<N, 1>;
  { p.propagate(x, step).jacobian } -> detail::shaped<N, N>;
};

/// Carries a state of N components over a step, in either direction of travel.
template <class P, class Scalar, int N, class Step>
concept propagator = linear_propagator<P, Scalar, N, Step> || general_propagator<P, Scalar, N, Step>;

/// q.covariance(step), q.covariance(start, step) or q.covariance(start, step, moved): the noise a step adds, at its end, N x N.
/// `moved` is the propagated state with its Jacobian J, which carries a noise W at the start of the step to its end as J W J'.
/// Law: symmetric and positive semidefinite for both directions of travel; zero for a step of no length.
template <class Q, class Scalar, int N, class Step>
concept process_noise = std::same_as<Q, no_noise> || requires(const Q& q, const vector<Scalar, N>& start, const Step& step, const propagated<Scalar, N>& moved) {
  requires detail::has_noise_covariance<Q, Scalar, N, Step>;
  { detail::noise_value<Scalar, N>(q, start, step, moved) } -> detail::shaped<N, N>;
};

/// m.value() (M), m.covariance() (M x M) and either m.projection() (H, M x N) or m.project(x), {value (M), jacobian (M x N)}.
/// Plain numbers serve where M = 1. Optional m.residual(value, expected), for wrapped angles.
/// Law: the error of value has mean zero and the given covariance and does not depend on that of any other measurement or noise;
/// jacobian is the derivative of the expected value by x; the covariance is positive definite.
template <class Z, class Scalar, int N>
concept measurement = requires(const Z& m, const vector<Scalar, N>& x) {
  { m.value() } -> detail::shaped<max_measurement_dimension<Z>, 1>;
  { m.covariance() } -> detail::shaped<max_measurement_dimension<Z>, max_measurement_dimension<Z>>;
  requires requires {
    { m.projection() } -> detail::shaped<max_measurement_dimension<Z>, N>;
  } || requires {
    { m.project(x).value } -> detail::shaped<max_measurement_dimension<Z>, 1>;
    { m.project(x).jacobian } -> detail::shaped<max_measurement_dimension<Z>, N>;
  };
};

/// u(prior, measurement) gives `updated`: the estimate after, with the residual, S, H, R and chi2 seen from before.
/// Law: a measurement of infinite covariance changes nothing; independent linear measurements may come in any order;
/// a failed update returns the prior and a status, and never throws.
template <class U, class Estimate, class Measurement>
concept update_policy = requires(const U& u, const Estimate& prior, const Measurement& m) {
  { u(prior, m) } -> std::convertible_to<basic_updated<Estimate, max_measurement_dimension<Measurement>>>;
};

/// g(chi2, measurement_dimension): true where the measurement is to be used; a bool, or a mask with one entry a lane.
/// Law: what it accepts at some chi2 it accepts at any smaller one. It must say false to NaN, or let the failed update decide.
template <class G, class Scalar>
concept gate = requires(const G& g, const Scalar& chi2, int dimension) {
  { g(chi2, dimension) } -> std::convertible_to<mask<Scalar>>;
} || requires(const G& g, const Scalar& chi2, int dimension) {
  { g(chi2, dimension) } -> std::same_as<bool>;
};

}  // namespace scifi::kalman
