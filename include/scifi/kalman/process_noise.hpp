// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <type_traits>

#include <scifi/core/linalg.hpp>
#include <scifi/kalman/model_value.hpp>
#include <scifi/kalman/shape.hpp>

namespace scifi::kalman {

/// No process noise, written out: a filter has none by default.
struct no_noise {};

namespace detail {

/// Stands where a filter was given no process noise.
struct missing_noise {};

template <class Q, class Scalar, int N, class Step>
concept noise_of_all = requires(const Q& q, const vector<Scalar, N>& start, const Step& step, const propagated<Scalar, N>& moved) { q.covariance(start, step, moved); };
template <class Q, class Scalar, int N, class Step>
concept noise_of_start = requires(const Q& q, const vector<Scalar, N>& start, const Step& step) { q.covariance(start, step); };
template <class Q, class Step>
concept noise_of_step = requires(const Q& q, const Step& step) { q.covariance(step); };

template <class Q, class Scalar, int N, class Step>
concept has_noise_covariance = noise_of_all<Q, Scalar, N, Step> || noise_of_start<Q, Scalar, N, Step> || noise_of_step<Q, Step>;

/// q.covariance with as many arguments as it takes; the longest list it accepts wins. `moved` is a `propagated`, or made from it.
template <class Scalar, int N, class Q, class Step, class Moved>
[[nodiscard]] decltype(auto) noise_value(const Q& q, const vector<Scalar, N>& start, const Step& step, const Moved& moved) {
  if constexpr (noise_of_all<Q, Scalar, N, Step>) return q.covariance(start, step, moved);
  else if constexpr (noise_of_start<Q, Scalar, N, Step>) return q.covariance(start, step);
  else return q.covariance(step);
}

/// The noise of a step, N x N, to be bound to a constant reference.
template <class Scalar, int N, class Q, class Step, class Moved>
[[nodiscard]] decltype(auto) noise_covariance(const Q& q, const vector<Scalar, N>& start, const Step& step, const Moved& moved) {
  if constexpr (std::is_same_v<Q, no_noise>) return matrix<Scalar, N, N>(matrix<Scalar, N, N>::Zero());
  else return converted<Scalar, N, N>([&]() -> decltype(auto) { return noise_value<Scalar, N>(q, start, step, moved); });
}

}  // namespace detail

}  // namespace scifi::kalman
