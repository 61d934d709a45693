// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstddef>
#include <iterator>
#include <span>

#include <scifi/kalman/filter.hpp>
#include <scifi/kalman/smoother.hpp>

namespace scifi::kalman {

namespace detail {

/// Smooths the nodes and the start of the first step, which is the first site where there is no step to take.
template <class Smoother, class Scalar, int N, int MaxM, class Step>
[[nodiscard]] status smooth_all(const Smoother& smoother, std::span<node<Scalar, N, MaxM>> nodes, const Step& first, estimate<Scalar, N>& start) {
  if constexpr (is_optional<Step>) {
    if (!first) {
      const status s = smoother(nodes);
      start = nodes[0].smoothed;
      return s;
    }
  }
  return smoother(nodes, &start);
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
/// good seed this is the filter linearised about a reference track. On failure the nodes reached are kept as `run` leaves them;
/// less than one pass fails with not_converged.
/// `settled(reference state, smoothed estimate)`, asked at the last site, may end it before all passes are made.
template <class Filter, class Scalar, int N, class Sites, class Nodes, class References, class Settled = detail::never_settled, class Smoother = rauch_tung_striebel>
[[nodiscard]] run_result<Scalar> run_relinearised(const Filter& filter, const estimate<Scalar, N>& start, const vector<Scalar, N>& seed, const Sites& sites, Nodes& nodes,
                                                  References& references, int passes, const Settled& settled = {}, const Smoother& smoother = {}) {
  const std::size_t k = std::size(sites);
  run_result<Scalar> result;
  if (passes < 1) {
    result.status = {step_kind::predict, reason::not_converged};
    return result;
  }
  references[0] = seed;
  for (int pass = 0; pass < passes; ++pass) {
    if (pass == 0) result = filter.run(start, sites, nodes, detail::flown_references<References>{references});
    else result = filter.run(start, sites, nodes, references);
    if (!result.status.ok() || k == 0) return result;
    const std::span reached(std::data(nodes), k);
    if (pass + 1 == passes) {
      result.status = smooth(reached, smoother);
      return result;
    }
    estimate<Scalar, N> begin = start;
    result.status = detail::smooth_all(smoother, reached, std::begin(sites)->step, begin);
    if (!result.status.ok() || settled(references[k], nodes[k - 1].smoothed)) return result;
    references[0] = begin.mean;
    for (std::size_t i = 0; i < k; ++i) references[i + 1] = nodes[i].smoothed.mean;
  }
  return result;
}

}  // namespace scifi::kalman
