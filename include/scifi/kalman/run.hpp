// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstddef>
#include <iterator>
#include <optional>
#include <span>
#include <type_traits>

#include <scifi/kalman/factored_estimate.hpp>
#include <scifi/kalman/measurement.hpp>
#include <scifi/kalman/node.hpp>
#include <scifi/kalman/propagation.hpp>

namespace scifi::kalman::detail {

/// Stands where a run has no reference states.
struct no_references {};

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

template <class Node, class Predicted, class Updated>
void record(Node& n, const Predicted& p, const Updated& u) {
  n.predicted = unfactored(p.estimate);
  n.jacobian = p.jacobian;
  n.noise = p.noise;
  n.filtered = unfactored(u.posterior);
  n.residual = u.residual;
  n.residual_covariance = u.residual_covariance;
  n.projection = u.jacobian;
  n.measurement_covariance = u.measurement_covariance;
  n.chi2 = u.chi2;
  n.measurement_dimension = u.measurement_dimension();
  n.outlier = u.outlier;
  n.status = u.status;
}

/// Where a reference state arrives after a step, which may be an empty optional.
template <class Propagator, class Scalar, int N, class Step>
[[nodiscard]] vector<Scalar, N> arrival(const Propagator& p, const vector<Scalar, N>& from, const Step& step) {
  return propagate(p, from, step).state;
}
template <class Propagator, class Scalar, int N, class Step>
[[nodiscard]] vector<Scalar, N> arrival(const Propagator& p, const vector<Scalar, N>& from, const std::optional<Step>& step) {
  return step ? arrival(p, from, *step) : from;
}

/// Predicts and updates over the sites; see filter::run.
template <class Filter, class Prior, class Sites, class Nodes, class References>
[[nodiscard]] auto run(const Filter& f, const Prior& start, const Sites& sites, Nodes& out, const References& references) {
  using estimate_type = kalman::detail::estimate_type<Prior>;
  using Scalar = typename estimate_type::scalar;
  run_result<Scalar> result;
  if constexpr (run_fits<Sites, Nodes, Scalar, estimate_type::dimension>::value) {
    const std::span nodes(out);
    result.status = status_in(start);
    if (!result.status.ok()) {
      result.failed_at = 0;
      return result;
    }
    const auto fail = [&result](status s) {
      result.status = s;
      result.failed_at = result.reached;
      return result;
    };
    estimate_type current = estimate_in(start);
    for (const auto& here : sites) {
      const std::size_t k = result.reached;
      if (k >= nodes.size()) return fail({step_kind::predict, reason::out_of_space});
      const auto one = [&] {
        if constexpr (std::is_same_v<References, no_references>) {
          const auto p = f.predict(current, here.step);
          const auto u = f.update(p, here.measurement);
          record(nodes[k], p, u);
          current = u.posterior;
          return u.status;
        } else {
          if (k >= std::size(references)) return status{step_kind::predict, reason::missing_reference};
          const auto& about = std::data(references)[k];
          const auto p = f.predict(current, here.step, about);
          const bool known = k + 1 < std::size(references);
          const auto u = f.update(p, here.measurement, known ? std::data(references)[k + 1] : arrival(f.propagator(), about, here.step));
          record(nodes[k], p, u);
          current = u.posterior;
          return u.status;
        }
      };
      const status s = one();
      if (!s.ok()) return fail(s);
      const auto& n = nodes[k];
      const Scalar zero(0.0);
      result.chi2 += select(n.outlier, zero, n.chi2);
      result.ndf += select(n.outlier, count<Scalar>(0), count<Scalar>(n.measurement_dimension));
      ++result.reached;
    }
  }
  return result;
}

}  // namespace scifi::kalman::detail
