// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstddef>
#include <iterator>

#include <scifi/kalman/filter.hpp>
#include <scifi/kalman/smoother.hpp>

namespace scifi::kalman {

namespace detail {

/// The state at the start of the first step, smoothed: that of the first site where there is no step to take.
template <class Scalar, int N, int MaxM, class Step>
[[nodiscard]] status smooth_start(const estimate<Scalar, N>& start, const node<Scalar, N, MaxM>& first, const Step& step, vector<Scalar, N>& smoothed) {
  if constexpr (is_optional<Step>) {
    if (!step) {
      smoothed = first.smoothed.mean;
      return {step_kind::smooth, reason::none};
    }
  }
  node<Scalar, N, MaxM> begin;
  begin.filtered = start;
  const status s = smooth_one(begin, first);
  if (s.ok()) smoothed = begin.smoothed.mean;
  return s;
}

/// No pass is left out.
struct never_settled {
  template <class State, class Estimate>
  [[nodiscard]] constexpr bool operator()(const State&, const Estimate&) const {
    return false;
  }
};

}  // namespace detail

/// Filters and smooths several times, each pass linearised along the smoothed states of the one before: the Gauss-Newton iteration for the whole
/// track, iterated extended Kalman smoother (Bell, SIAM J. Optim. 4 (1994) 626). The first pass is linearised along the flight of `seed`.
///
/// `sites`, `nodes` and `references` are contiguous; nodes has as many elements as sites, references one more. Does not allocate. With one pass and a
/// good seed this is the filter linearised about a reference track. On failure the nodes reached are kept as `run` leaves them.
/// `settled(reference state, smoothed estimate)`, asked at the last site, may end it before all passes are made.
template <class Filter, class Scalar, int N, class Sites, class Nodes, class References, class Settled = detail::never_settled>
[[nodiscard]] run_result<Scalar> run_relinearised(const Filter& filter, const estimate<Scalar, N>& start, const vector<Scalar, N>& seed, const Sites& sites, Nodes& nodes,
                                                  References& references, int passes, const Settled& settled = {}) {
  references[0] = seed;
  std::size_t k = 0;
  for (const auto& site : sites) {
    references[k + 1] = detail::arrival(filter.propagator(), references[k], site.step);
    ++k;
  }
  run_result<Scalar> result;
  for (int pass = 0; pass < passes; ++pass) {
    if (pass > 0 && k > 0) {
      result.status = detail::smooth_start(start, nodes[0], std::begin(sites)->step, references[0]);
      if (!result.status.ok()) return result;
      for (std::size_t i = 0; i < k; ++i) references[i + 1] = nodes[i].smoothed.mean;
    }
    result = filter.run(start, sites, nodes, references);
    if (!result.status.ok()) return result;
    result.status = smooth(nodes);
    if (!result.status.ok() || (k > 0 && settled(references[k], nodes[k - 1].smoothed))) return result;
  }
  return result;
}

}  // namespace scifi::kalman
