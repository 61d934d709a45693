// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <new>
#include <type_traits>

#include <scifi/kalman/apply_gate.hpp>
#include <scifi/kalman/concepts.hpp>
#include <scifi/kalman/correction.hpp>
#include <scifi/kalman/in_some_lanes.hpp>
#include <scifi/kalman/process_noise.hpp>
#include <scifi/kalman/propagation.hpp>
#include <scifi/kalman/sentences.hpp>
#include <scifi/kalman/step_covariance.hpp>

namespace scifi::kalman {

/// What `filter::advance` says beside the estimate.
template <class Scalar>
struct outcome {
  /// Of the residual before the update, also where the gate rejected the measurement.
  Scalar chi2{0.0};
  kalman::status status{step_kind::update, reason::none};
  mask<Scalar> outlier{};
};

namespace detail {

template <class Policy, class Scalar, int N, int M>
concept corrects = requires(const Policy& p, const estimate<Scalar, N>& prior, const innovation_view<Scalar, N, M>& seen, const gain<Scalar, N, M>& k, estimate<Scalar, N>& posterior) {
  p.correct(prior, seen, k, posterior);
};

/// True where a posterior can be written where it is to stay: of an estimate with its covariance, by parts that fit, with a measurement of one dimension.
template <class Update, class Gate, class Estimate, class Measurement>
inline constexpr bool corrects_in_place = [] {
  using Scalar = typename Estimate::scalar;
  constexpr int N = Estimate::dimension;
  constexpr int M = max_measurement_dimension<Measurement>;
  if constexpr (mixed_measurement<Measurement> || M == 0 || !std::is_same_v<Estimate, estimate<Scalar, N>>) return false;
  else return corrects<Update, Scalar, N, M> && measurement<Measurement, Scalar, N> && gate<Gate, Scalar>;
}();

/// Likewise for a step; one that does not fit, or may be absent, is left to `filter::predict`.
template <class Propagator, class Noise, class Estimate, class Step>
inline constexpr bool steps_in_place = propagator<Propagator, typename Estimate::scalar, Estimate::dimension, Step> &&
                                       process_noise<Noise, typename Estimate::scalar, Estimate::dimension, Step> && model_spaces_agree<Propagator, Noise>::value;

/// use(end, F, Q) of a step from x; F and Q are not copied where the model keeps them.
template <class Propagator, class Noise, class Scalar, int N, class Step, class Use>
[[gnu::always_inline]] inline void with_step(const Propagator& p, const Noise& q, const vector<Scalar, N>& x, const Step& step, const Use& use) {
  if constexpr (has_transition<Propagator, Step> && !has_propagate<Propagator, Scalar, N, Step> && !noise_of_all<Noise, Scalar, N, Step>) {
    const matrix<Scalar, N, N>& f = converted<Scalar, N, N>([&]() -> decltype(auto) { return p.transition(step); });
    const matrix<Scalar, N, N>& noise = noise_covariance<Scalar, N>(q, x, step, x);
    use(times_vector<Scalar, N, N>(f, x), f, noise);
  } else {
    const auto moved = propagate_fully(p, x, step);
    const matrix<Scalar, N, N>& noise = noise_covariance<Scalar, N>(q, x, step, moved);
    use(moved.state, moved.jacobian, noise);
  }
}

/// A step of a model that writes its results where they are to stay: a function of its own, for in line with the filter the two would crowd each other's registers.
template <class Propagator, class Noise, class Scalar, int N, class Step>
[[gnu::noinline]] void take_step(const Propagator& p, const Noise& q, const vector<Scalar, N>& x, const Step& step, const propagated_view<Scalar, N>& end, matrix<Scalar, N, N>& noise) {
  q.covariance_into(noise, x, step, p.propagate_into(end, x, step));
}

/// The end of a step from x, F and Q, written where they are to stay, which is not where x is.
template <class Propagator, class Noise, class Scalar, int N, class Step>
[[gnu::always_inline]] inline void set_step(const Propagator& p, const Noise& q, const vector<Scalar, N>& x, const Step& step, vector<Scalar, N>& end, matrix<Scalar, N, N>& jacobian,
                                            matrix<Scalar, N, N>& noise) {
  if constexpr (models_in_place<Propagator, Noise, Scalar, N, Step>) {
    take_step(p, q, x, step, propagated_view<Scalar, N>{end, jacobian}, noise);
  } else {
    const auto moved = propagate_fully(p, x, step);
    copy_columns<Scalar, N, N>(jacobian, moved.jacobian);
    ::new (static_cast<void*>(&noise)) matrix<Scalar, N, N>(noise_covariance<Scalar, N>(q, x, step, moved));  // made in its place
    end = moved.state;
  }
}

template <class Propagator, class Noise, class Update, class Gate, class Scalar, int N, class Step, class Measurement>
[[nodiscard]] inline outcome<Scalar> advance(const Propagator& p, const Noise& q, const Update& update, const Gate& gate, estimate<Scalar, N>& e, const Step& step, const Measurement& m) {
  outcome<Scalar> out;
  estimate<Scalar, N> moved;
  with_step(p, q, e.mean, step, [&](const vector<Scalar, N>& end, const matrix<Scalar, N, N>& f, const matrix<Scalar, N, N>& noise) __attribute__((always_inline)) {
    copy_columns<Scalar, N, 1>(moved.mean, end);
    carry_covariance<unit_columns_of<Propagator>(), Scalar, N>(moved.covariance, f, e.covariance, noise);
  });
  const reason why = fault_of(moved.mean, moved.covariance);
  if (why != reason::none) {
    out.status = {step_kind::predict, why};
    return out;
  }
  out.status = correct_into(update, moved, m, e, out.chi2);
  apply_gate<max_measurement_dimension<Measurement>>(gate, moved, e, out);
  keep_absent_lanes(m, moved, e, out);
  return out;
}

}  // namespace detail

}  // namespace scifi::kalman
