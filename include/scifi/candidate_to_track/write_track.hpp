// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <type_traits>

#include <scifi/candidate_to_track/fit_memory.hpp>
#include <scifi/candidate_to_track/fit_path.hpp>
#include <scifi/candidate_to_track/fit_probability.hpp>
#include <scifi/core/lane.hpp>
#include <scifi/kalman/node_residual.hpp>
#include <scifi/track_model/conversions.hpp>

namespace scifi {

/// The estimate in one lane, in double precision.
template <class Scalar, int N>
[[nodiscard]] kalman::estimate<double, N> lane_of(const kalman::estimate<Scalar, N>& e, int lane) {
  if constexpr (std::is_same_v<Scalar, double>) {
    return e;
  } else {
    kalman::estimate<double, N> out;
    for (int i = 0; i < N; ++i) out.mean[i] = static_cast<double>(lane_of(e.mean[i], lane));
    for (int j = 0; j < N; ++j)
      for (int i = 0; i < N; ++i) out.covariance(i, j) = static_cast<double>(lane_of(e.covariance(i, j), lane));
    return out;
  }
}

/// A track that could not be fitted: its status and no points.
inline void write_failure(const fit_path& path, const fit_job& job, kalman::status why, fitted_track& out) {
  out.points.clear();
  std::construct_at(&out.summary);
  out.summary.tracker = job.from->tracker;
  out.summary.candidate = job.index;
  out.summary.shape = job.from->shape;
  out.summary.z = path.z_reference;
  out.summary.status = why;
}

namespace detail {

/// Appends what the fit says at one surface; returns the variance of the residual without its own measurement, infinite where there is none.
template <class Node, class ToSlopes>
double add_point(const Node& n, int lane, const surface& at, int cluster, const ToSlopes& to_slopes, fitted_track& out) {
  double variance = std::numeric_limits<double>::infinity();
  track_point p;
  p.station = at.station;
  p.plane = at.plane;
  p.z = at.z;
  p.smoothed = to_slopes(lane_of(n.smoothed, lane));
  p.residual = p.pull = std::numeric_limits<double>::quiet_NaN();
  if (cluster >= 0) {
    const auto unbiased = kalman::unbiased_residual(n);
    p.residual = static_cast<double>(lane_of(unbiased.value(0), lane));
    variance = static_cast<double>(lane_of(unbiased.covariance(0, 0), lane));
    p.pull = p.residual / std::sqrt(variance);
    p.chi2 = static_cast<double>(lane_of(n.chi2, lane));
    p.outlier = lane_of(n.outlier, lane);
    p.cluster = cluster;
    if (!p.outlier) {
      const bool seen = std::any_of(out.points.begin(), out.points.end(), [&at](const track_point& q) { return q.station == at.station && q.cluster >= 0 && !q.outlier; });
      out.summary.stations += seen ? 0 : 1;
      ++out.summary.planes;
    }
  }
  ++out.summary.points;
  out.points.push_back(p);
  return variance;
}

/// What is wrong with one lane of a node.
template <class Node>
[[nodiscard]] kalman::status fault_in_lane(const Node& n, int lane) {
  for (const auto* e : {&n.predicted, &n.filtered, &n.smoothed}) {
    double sum = 0.0;
    double lowest = 0.0;
    for (int i = 0; i < Node::dimension; ++i) {
      const double variance = static_cast<double>(lane_of(e->covariance(i, i), lane));
      sum += static_cast<double>(lane_of(e->mean[i], lane)) + variance;
      lowest = std::min(lowest, variance);
    }
    if (!is_finite(sum)) return {kalman::step_kind::smooth, kalman::reason::not_finite};
    if (lowest < 0.0) return {kalman::step_kind::smooth, kalman::reason::not_positive_definite};
  }
  return {kalman::step_kind::smooth, is_finite(static_cast<double>(lane_of(n.chi2, lane))) ? kalman::reason::none : kalman::reason::singular_innovation};
}

}  // namespace detail

/// Writes the track of one lane from the smoothed nodes of a fit: a failure with its status where the lane failed. `probability` says how well it fits.
template <class StateSpace, class Scalar, class Leg, class ToSlopes, class Probability = gaussian_probability>
void write_track(const fit_path& path, int travel, const fit_memory<StateSpace, Scalar, Leg>& work, const fit_job& job, std::size_t lane, const ToSlopes& to_slopes, fitted_track& out,
                 const Probability& probability = {}) {
  const std::size_t surfaces = path.surfaces.size();
  const int in = static_cast<int>(lane);
  kalman::status status{kalman::step_kind::smooth, kalman::reason::none};
  if constexpr (lane_count<Scalar> > 1) {
    for (std::size_t i = 0; i <= surfaces && status.ok(); ++i) status = detail::fault_in_lane(work.nodes[i], in);
  }
  write_failure(path, job, status, out);
  if (!status.ok()) return;

  track& t = out.summary;
  for (std::size_t i = 0; i < surfaces; ++i) {
    const auto& n = work.nodes[i];
    if (work.cluster_at[lane * surfaces + i] < 0 || lane_of(n.outlier, in)) continue;
    t.chi2 += static_cast<double>(lane_of(n.chi2, in));
    ++t.ndf;
  }
  t.ndf -= StateSpace::dimension;
  const kalman::estimate<double, 5> at_reference = to_slopes(lane_of(work.nodes[surfaces].smoothed, in));
  t.charge = (at_reference.mean[slope_state::q_over_pz] < 0.0 ? -1 : 1) * travel;
  t.reference = convert(at_reference, [travel](const vector<double, 5>& x) { return slopes_to_momentum(x, travel); });
  // q/pz so near to zero that the momentum is beyond all numbers.
  const double of_reference = t.reference.mean.sum() + t.reference.covariance.sum();
  if (!is_finite(of_reference)) return write_failure(path, job, {kalman::step_kind::smooth, kalman::reason::not_finite}, out);
  fit_summary how = closures_of(*job.from, job.points);
  for (std::size_t i = surfaces; i-- > 0;) {
    const int member = work.cluster_at[lane * surfaces + i];
    const double variance = detail::add_point(work.nodes[i], in, path.surfaces[i], member, to_slopes, out);
    // var(smoothed residual)/R = R/var(residual without its own measurement).
    if (member >= 0 && !out.points.back().outlier) how.measurement += job.clusters[static_cast<std::size_t>(member)].variance / variance;
  }
  how.chi2 = t.chi2;
  how.ndf = t.ndf;
  how.inner_stations = std::max(0, t.stations - 2);
  t.p_value = probability(how);
}

}  // namespace scifi
