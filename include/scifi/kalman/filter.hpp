// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <optional>
#include <utility>

#include <scifi/kalman/advance.hpp>
#include <scifi/kalman/apply_gate.hpp>
#include <scifi/kalman/factored_estimate.hpp>
#include <scifi/kalman/gate.hpp>
#include <scifi/kalman/in_some_lanes.hpp>
#include <scifi/kalman/joseph.hpp>
#include <scifi/kalman/run.hpp>
#include <scifi/kalman/sentences.hpp>
#include <scifi/kalman/step_covariance.hpp>
#include <scifi/kalman/triangular.hpp>

namespace scifi::kalman {

/// The Kalman filter (Kalman 1960; extended to first order for non-linear parts), put together from its parts, which it keeps by value.
///
/// predict, update and run take an estimate, a factored estimate, or the result of a predict or update, so that calls chain; a status
/// that is not ok is passed on and nothing is done. No call allocates, throws or changes the filter.
template <class Propagator, class Noise = detail::missing_noise, class Update = joseph, class Gate = no_gate>
class filter {
  static_assert(!std::is_same_v<Noise, detail::missing_noise>, "scifi: the filter was given no process noise; write no_noise{} if there is none");

 public:
  constexpr explicit filter(Propagator propagator, Noise noise = Noise{}, Update update = Update{}, Gate gate = Gate{})
      : propagator_(std::move(propagator)), noise_(std::move(noise)), update_(std::move(update)), gate_(std::move(gate)) {}

  [[nodiscard]] constexpr const Propagator& propagator() const { return propagator_; }
  [[nodiscard]] constexpr const Noise& noise() const { return noise_; }

  /// The estimate after a step: mean f(x), covariance F P F' + Q. A std::optional step that is empty changes nothing.
  template <class Prior, class Step>
  [[nodiscard]] auto predict(const Prior& prior, const Step& step) const {
    return predict_about(prior, step, nullptr);
  }

  /// The same with the model linearised at the state `about` at the start of the step: mean f(about) + F (x - about).
  template <class Prior, class Step, class Scalar, int N>
  [[nodiscard]] auto predict(const Prior& prior, const Step& step, const vector<Scalar, N>& about) const {
    return predict_about(prior, step, &about);
  }

  /// The same, with the state in which `about` ends left in `arrived`; that may be `about` itself.
  template <class Prior, class Step, class Scalar, int N>
  [[nodiscard]] auto predict(const Prior& prior, const Step& step, const vector<Scalar, N>& about, vector<Scalar, N>& arrived) const {
    return predict_about(prior, step, &about, &arrived);
  }

  /// The estimate with a measurement taken in. A variant or optional of measurements gives a result of run-time dimension.
  template <class Prior, class Measurement>
  [[nodiscard]] auto update(const Prior& prior, const Measurement& m) const {
    return update_about(prior, m, nullptr);
  }

  /// The same with the measurement linearised at the state `about`.
  template <class Prior, class Measurement, class Scalar, int N>
  [[nodiscard]] auto update(const Prior& prior, const Measurement& m, const vector<Scalar, N>& about) const {
    return update_about(prior, m, &about);
  }

  /// One step and the measurement at its end: `e` becomes the posterior of update(predict(e, step), m). The fastest way along, for it keeps no record of
  /// Jacobians, residuals and their covariances. Where it fails `e` is left as it was before the part that failed.
  template <class Estimate, class Step, class Measurement>
  [[nodiscard]] outcome<typename Estimate::scalar> advance(Estimate& e, const Step& step, const Measurement& m) const {
    if constexpr (updates_in_place<Estimate, Measurement> && detail::steps_in_place<Propagator, Noise, Estimate, Step>) {
      return detail::advance(propagator_, noise_, update_, gate_, e, step, m);
    } else {
      const auto u = update(predict(e, step), m);
      e = u.posterior;
      return {u.chi2, u.status, u.outlier};
    }
  }

  /// Filters over the sites in their order and leaves a node for each in `out` (contiguous, at least as many). Stops at the first failure.
  template <class Prior, class Sites, class Nodes>
  [[nodiscard]] auto run(const Prior& start, const Sites& sites, Nodes&& out) const {
    return detail::run_from(*this, start, sites, out, detail::no_references{});
  }

  /// The same, linearised along reference states (contiguous range of vectors): references[k] is the state at the start of step k, that
  /// is at site k-1; measurement k is taken at references[k+1], or, where that is not given, at the end of the step from references[k].
  template <class Prior, class Sites, class Nodes, class References>
  [[nodiscard]] auto run(const Prior& start, const Sites& sites, Nodes&& out, const References& references) const {
    return detail::run_from(*this, start, sites, out, references);
  }

  /// `detail::run` has the filter write into the nodes.
  template <class Filter, class Prior, class Sites, class Nodes, class References>
  friend auto detail::run(const Filter& f, const Prior& start, const Sites& sites, Nodes& out, const References& references);

 private:
  template <class Prior, class Step, class About, class Arrived = std::nullptr_t>
  [[nodiscard]] auto predict_about(const Prior& prior, const Step& step, const About& about, const Arrived& arrived = nullptr) const {
    if constexpr (detail::prior_fits<Prior>::value) {
      basic_predicted<detail::estimate_type<Prior>> out;
      out.status = detail::status_in(prior);
      if (out.status.ok()) {
        out.status = predict_into(detail::estimate_in(prior), step, about, arrived, out.estimate, out.jacobian, out.noise);
      } else {
        out.estimate = detail::estimate_in(prior);
        out.jacobian.setIdentity();
        out.noise.setZero();
      }
      return out;
    }
  }

  /// The prediction written where it is to stay.
  template <class Estimate, class Step, class About, class Arrived, class Square>
  [[nodiscard]] status predict_into(const Estimate& prior, const Step& step, const About& about, const Arrived& arrived, Estimate& end, Square& jacobian, Square& noise) const {
    vector<typename Estimate::scalar, Estimate::dimension> flown;
    if constexpr (std::is_same_v<About, std::nullptr_t>) fly_into<Estimate>(prior.mean, step, flown, jacobian, noise);
    else fly_into<Estimate>(*about, step, flown, jacobian, noise);
    const status s = carry_into(prior, step, about, flown, jacobian, noise, end);
    if constexpr (!std::is_same_v<Arrived, std::nullptr_t>) *arrived = flown;
    return s;
  }

  /// The model's part of a step: where the state `from` ends, the Jacobian of the way and its noise.
  template <class Estimate, class Step, class State, class Square>
  [[gnu::always_inline]] void fly_into(const State& from, const Step& step, State& arrived, Square& jacobian, Square& noise) const {
    using Scalar = typename Estimate::scalar;
    constexpr int N = Estimate::dimension;
    if constexpr (detail::is_reference<Step>) return fly_into<Estimate>(from, step.get(), arrived, jacobian, noise);
    else if constexpr (detail::is_optional<Step>) {
      if (step) return fly_into<Estimate>(from, *step, arrived, jacobian, noise);
    } else if constexpr (detail::model_spaces_agree<Propagator, Noise>::value && detail::propagator_fits<Propagator, Scalar, N, Step>::value &&
                         detail::noise_fits<Noise, Scalar, N, Step>::value) {
      return detail::set_step(propagator_, noise_, from, step, arrived, jacobian, noise);
    }
    jacobian.setIdentity();  // no step to take, or behind an error
    noise.setZero();
    arrived = from;
  }

  /// The filter's part: the estimate carried over a step that `about`, or its own mean, was flown over.
  template <class Estimate, class Step, class About, class State, class Square>
  [[nodiscard, gnu::always_inline]] status carry_into(const Estimate& prior, const Step& step, const About& about, const State& arrived, const Square& jacobian, const Square& noise, Estimate& end) const {
    using Scalar = typename Estimate::scalar;
    constexpr int N = Estimate::dimension;
    if constexpr (detail::is_reference<Step>) return carry_into(prior, step.get(), about, arrived, jacobian, noise, end);
    else if constexpr (detail::is_optional<Step>) {
      if (step) return carry_into(prior, *step, about, arrived, jacobian, noise, end);
      end = prior;
      return {step_kind::predict, reason::none};
    } else {
      end.mean = arrived;
      if constexpr (!std::is_same_v<About, std::nullptr_t>) end.mean += detail::times_vector<Scalar, N, N>(jacobian, prior.mean - *about);
      reason why = reason::none;
      if constexpr (std::is_same_v<Estimate, kalman::estimate<Scalar, N>>) {
        detail::carry_covariance<detail::unit_columns_of<Propagator>(), Scalar, N>(end.covariance, jacobian, prior.covariance, noise);
        why = fault_of(end.mean, end.covariance);
      } else {
        matrix<Scalar, N, 2 * N> array;
        array.template leftCols<N>() = jacobian.lazyProduct(prior.factor);
        array.template rightCols<N>() = semidefinite_factor<Scalar, N>(noise);
        end.factor = lower_triangular<Scalar, N, 2 * N>(array);
        why = fault_of(end.mean, end.factor);
      }
      if (why != reason::none) end = prior;
      return {step_kind::predict, why};
    }
  }

  template <class Prior, class Measurement, class About>
  [[nodiscard]] auto update_about(const Prior& prior, const Measurement& m, const About& about) const {
    if constexpr (detail::prior_fits<Prior>::value) {
      using estimate_type = detail::estimate_type<Prior>;
      constexpr int M = max_measurement_dimension<Measurement>;
      if constexpr (mixed_measurement<Measurement>) {
        using result = basic_updated<estimate_type, Eigen::Dynamic, M>;
        return detail::visit_measurement(m, [&](const auto& one) -> result { return detail::mixed<result>(update_about(prior, one, about)); });
      } else {
        using result = basic_updated<estimate_type, M>;
        if constexpr (!std::is_same_v<Measurement, no_measurement>) {
          if (detail::status_in(prior).ok()) return taken_in(detail::estimate_in(prior), m, about);
        }
        result out{detail::estimate_in(prior), {}, {}, {}, {}};
        detail::clear(out);
        out.status = detail::status_in(prior);
        if (out.status.ok()) out.status.step = step_kind::update;
        return out;
      }
    }
  }

  template <class Estimate, class Measurement, class About>
  [[nodiscard]] auto taken_in(const Estimate& prior, const Measurement& m, const About& about) const -> basic_updated<Estimate, max_measurement_dimension<Measurement>> {
    using Scalar = typename Estimate::scalar;
    constexpr int N = Estimate::dimension;
    constexpr int M = max_measurement_dimension<Measurement>;
    if constexpr (detail::measurement_space_agrees<Propagator, Measurement>::value && detail::measurement_fits<Measurement, Scalar, N>::value &&
                  detail::gate_fits<Gate, Scalar>::value) {
      if constexpr (std::is_same_v<About, std::nullptr_t> || detail::is_own_tangent<Measurement, Scalar, N>) {
        if constexpr (detail::update_fits<Update, Estimate, Measurement>::value) return gated(prior, m);
      } else {
        if constexpr (detail::update_fits<Update, Estimate, linear_measurement<Scalar, N, M>>::value) return gated(prior, linearise(m, *about));
      }
    }
    return {prior, {}, {}, {}, {}};  // behind an error
  }

  /// True where the posterior can be written where it is to stay: a policy that allows it, and a measurement that need not be linearised first.
  template <class Estimate, class Measurement, class... About>
  static constexpr bool updates_in_place = [] {
    using Scalar = typename Estimate::scalar;
    constexpr bool tangent = sizeof...(About) == 0 || detail::is_own_tangent<Measurement, Scalar, Estimate::dimension>;
    return tangent && detail::corrects_in_place<Update, Gate, Estimate, Measurement> && detail::measurement_space_agrees<Propagator, Measurement>::value;
  }();

  template <class Estimate, class Measurement, class Node, class... About>
  [[gnu::always_inline]] void update_into(const Estimate& prior, const Measurement& m, Node& n, const About&...) const {
    constexpr int M = max_measurement_dimension<Measurement>;
    const auto record = [&n](const auto& seen, const auto& k) {
      detail::assign_bounded(n.residual, seen.residual);
      detail::assign_bounded(n.residual_covariance, k.residual_covariance);
      detail::assign_bounded(n.projection, seen.jacobian);
      detail::assign_bounded(n.measurement_covariance, seen.covariance);
    };
    n.status = detail::correct_into(update_, prior, m, n.filtered, n.chi2, record);
    n.measurement_dimension = M;
    n.outlier = {};
    detail::apply_gate<M>(gate_, prior, n.filtered, n);
    detail::keep_absent_lanes(m, prior, n.filtered, n);
  }

  template <class Estimate, class Measurement>
  [[nodiscard]] auto gated(const Estimate& prior, const Measurement& m) const -> basic_updated<Estimate, max_measurement_dimension<Measurement>> {
    basic_updated<Estimate, max_measurement_dimension<Measurement>> out = update_(prior, m);
    detail::apply_gate<max_measurement_dimension<Measurement>>(gate_, prior, out.posterior, out);
    detail::keep_absent_lanes(m, prior, out.posterior, out);
    return out;
  }

  [[no_unique_address]] Propagator propagator_;
  [[no_unique_address]] Noise noise_;
  [[no_unique_address]] Update update_;
  [[no_unique_address]] Gate gate_;
};

}  // namespace scifi::kalman
