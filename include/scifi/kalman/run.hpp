// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstddef>
#include <iterator>
#include <span>
#include <type_traits>
#include <variant>

#include <scifi/kalman/apply_gate.hpp>
#include <scifi/kalman/factored_estimate.hpp>
#include <scifi/kalman/measurement.hpp>
#include <scifi/kalman/node.hpp>
#include <scifi/kalman/node_view.hpp>
#include <scifi/kalman/product.hpp>
#include <scifi/kalman/sentences.hpp>

namespace scifi::kalman::detail {

/// Stands where a run has no reference states.
struct no_references {};

/// Reference states of which the first is given and each further one is set to where the one before it arrives.
template <class States>
struct flown_references {
  States& states;
};

template <class References>
inline constexpr bool is_flown = false;
template <class States>
inline constexpr bool is_flown<flown_references<States>> = true;

template <class Sites>
using site_type = std::remove_cvref_t<decltype(*std::begin(std::declval<const Sites&>()))>;

template <class Nodes>
using node_type = std::remove_cvref_t<decltype(*std::begin(std::declval<Nodes&>()))>;

/// Checks that sites have their members and that the nodes have room for their measurements.
template <class Sites, class Nodes, class Scalar, int N>
struct run_fits {
  using site = site_type<Sites>;
  static constexpr bool complete = requires(const site& s) { s.step; s.measurement; };
  static_assert(complete, "scifi: a site must have the members step and measurement");
  static constexpr bool same_state = std::is_same_v<typename node_type<Nodes>::scalar, Scalar> && node_type<Nodes>::dimension == N;
  static_assert(same_state, "scifi: the nodes of a run must have the scalar and the dimension of its start estimate");
  static constexpr bool room = [] {
    if constexpr (complete) return max_measurement_dimension<std::remove_cvref_t<decltype(std::declval<const site&>().measurement)>> <= node_type<Nodes>::max_measurement_dimension;
    else return true;
  }();
  static_assert(room, "scifi: the nodes of a run have no room for a measurement of this dimension");
  static constexpr bool value = complete && same_state && room;
};

template <class Scalar, int N>
void set_estimate(estimate<Scalar, N>& out, const estimate<Scalar, N>& e) {
  out.mean = e.mean;
  copy_columns<Scalar, N, N>(out.covariance, e.covariance);
}

template <class Node, class Updated>
[[gnu::noinline]] void record_update(Node& n, const Updated& u) {
  set_estimate<typename Node::scalar, Node::dimension>(n.filtered, unfactored(u.posterior));
  assign_bounded(n.residual, u.residual);
  assign_bounded(n.residual_covariance, u.residual_covariance);
  assign_bounded(n.projection, u.jacobian);
  assign_bounded(n.measurement_covariance, u.measurement_covariance);
  n.chi2 = u.chi2;
  n.measurement_dimension = u.measurement_dimension();
  n.outlier = u.outlier;
  n.status = u.status;
}

/// Predicts and updates over the sites; see filter::run.
template <class Filter, class Prior, class Sites, class Nodes, class References>
[[nodiscard]] auto run(const Filter& f, const Prior& start, const Sites& sites, Nodes& out, const References& references) {
  using estimate_type = kalman::detail::estimate_type<Prior>;
  using Scalar = typename estimate_type::scalar;
  run_result<Scalar> result;
  if constexpr (run_fits<Sites, Nodes, Scalar, estimate_type::dimension>::value) {
    const std::span nodes(out);
    const auto fail = [&](status s) {
      result.status = s;
      result.failed_at = result.reached;
      if (result.reached < nodes.size()) nodes[result.reached].status = s;
      return result;
    };
    if (!status_in(start).ok()) return fail(status_in(start));
    estimate_type after_update = estimate_in(start);
    const estimate_type* current = &after_update;
    // A flight that does not hang on what is measured goes one step ahead: it and the filter do not wait for each other.
    [[maybe_unused]] const auto fly_ahead = [&](const auto& step, std::size_t k) {
      if constexpr (is_flown<References>) {
        auto& states = references.states;
        if (k < nodes.size() && k + 1 < std::size(states)) f.template fly_into<estimate_type>(std::data(states)[k], step, std::data(states)[k + 1], nodes[k].jacobian, nodes[k].noise);
      }
    };
    auto ahead = std::begin(sites);
    std::size_t flown = 0;
    for (const auto& here : sites) {
      const std::size_t k = result.reached;
      for (; flown <= k + 1 && ahead != std::end(sites); ++ahead, ++flown) fly_ahead(ahead->step, flown);
      if (k >= nodes.size()) return fail({step_kind::predict, reason::out_of_space});
      auto& n = nodes[k];
      constexpr bool factored = !std::is_same_v<estimate_type, std::remove_cvref_t<decltype(n.filtered)>>;
      std::conditional_t<factored, estimate_type, std::monostate> own_prediction;
      auto& prediction = [&]() -> estimate_type& {
        if constexpr (factored) return own_prediction;
        else return n.predicted;
      }();
      [[maybe_unused]] const auto predict = [&](const auto& about, const auto& arrived) __attribute__((always_inline)) { return f.predict_into(*current, here.step, about, arrived, prediction, n.jacobian, n.noise); };
      // Each alternative of a mixed measurement is taken in by matrices of its own size.
      const auto take = [&](status predicted, const auto&... about) __attribute__((always_inline)) {
        if constexpr (factored) n.predicted = unfactored(prediction);
        each_alternative(here.measurement, [&](const auto& m) __attribute__((always_inline)) {
          if constexpr (!factored) {
            if constexpr (std::remove_cvref_t<decltype(f)>::template updates_in_place<estimate_type, std::remove_cvref_t<decltype(m)>, decltype(about)...>) {
              if (predicted.ok()) {
                f.update_into(prediction, m, n, about...);
                current = &n.filtered;
                return;
              }
            }
          }
          const auto u = f.update(basic_prior<estimate_type>{prediction, predicted}, m, about...);
          record_update(n, u);
          if constexpr (factored) after_update = u.posterior;
          else current = &n.filtered;
        });
        return n.status;
      };
      const auto one = [&]() __attribute__((always_inline)) {
        if constexpr (std::is_same_v<References, no_references>) {
          return take(predict(nullptr, nullptr));
        } else if constexpr (is_flown<References>) {
          auto& states = references.states;
          if (k + 1 >= std::size(states)) return status{step_kind::predict, reason::missing_reference};
          return take(f.carry_into(*current, here.step, std::data(states) + k, std::data(states)[k + 1], n.jacobian, n.noise, prediction), std::data(states)[k + 1]);
        } else {
          if (k >= std::size(references)) return status{step_kind::predict, reason::missing_reference};
          vector<Scalar, estimate_type::dimension> arrived;
          const status s = predict(std::data(references) + k, &arrived);
          return k + 1 < std::size(references) ? take(s, std::data(references)[k + 1]) : take(s, arrived);
        }
      };
      const status s = one();
      if (!s.ok()) return fail(s);
      const Scalar zero(0.0);
      result.chi2 += select(n.outlier, zero, n.chi2);
      result.ndf += select(n.outlier, count<Scalar>(0), count<Scalar>(n.measurement_dimension));
      ++result.reached;
    }
    // Steps look at variances only. What else is not finite, from a noise say, stays in the covariance: one look at the end sees it.
    if (result.reached > 0) {
      const auto& last = nodes[result.reached - 1];
      Scalar sum(0.0);
      for (int j = 0; j < estimate_type::dimension; ++j)
        for (int i = 0; i < estimate_type::dimension; ++i) sum += last.filtered.covariance(i, j);
      if (!any_of(is_finite<Scalar>(sum))) {
        --result.reached;
        return fail({step_kind::update, reason::not_finite});
      }
    }
    // Nodes behind the last site may hold what an earlier run left: a smoother stops here.
    if (result.reached < nodes.size()) nodes[result.reached].status = {step_kind::predict, reason::not_reached};
  }
  return result;
}

/// The same from whatever the user gave as the start.
template <class Filter, class Prior, class Sites, class Nodes, class References>
[[nodiscard]] auto run_from(const Filter& f, const Prior& start, const Sites& sites, Nodes& out, const References& references) {
  if constexpr (prior_fits<Prior>::value) return run(f, start, sites, out, references);
  else return run_result<double>{};
}

}  // namespace scifi::kalman::detail
