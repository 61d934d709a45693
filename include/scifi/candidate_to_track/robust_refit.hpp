// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include <scifi/candidate_to_track/fit_memory.hpp>
#include <scifi/candidate_to_track/fit_path.hpp>
#include <scifi/candidate_to_track/fit_stops.hpp>
#include <scifi/core/linalg.hpp>
#include <scifi/kalman/filter.hpp>
#include <scifi/kalman/node.hpp>
#include <scifi/kalman/smoother.hpp>
#include <scifi/material/scattering_tail.hpp>
#include <scifi/track_model/conversions.hpp>
#include <scifi/track_model/fibre_measurement.hpp>
#include <scifi/track_model/weighted_leg.hpp>

namespace scifi {

/// The plain fit is the last word.
struct no_refit {
  template <class StateSpace>
  struct buffers {};
};

/// Fits a track that fits badly again under every simple reason for that, and takes the mean of all, each with its probability given the data.
///
/// Reasons: nothing special; a wider or a hard scatter (`tail`) in one station that has measurements on either side; one measurement that is not of this track.
/// Each is a filter and smoother of its own about the reference states of the plain fit; its weight is its prior times the likelihood of the
/// innovations, prod N(r; 0, S): a Gaussian sum over static hypotheses (Alspach and Sorenson, IEEE Trans. Autom. Control 17 (1972) 439). In the limit of one reason
/// that explains all it is the fit with that scatter freed or that measurement left out; where nothing is sure the errors say so. chi2, residuals
/// and p-value stay those of the plain fit: they say that the track was not plain. About 25 fits for a track that needs it, nothing for others.
struct robust_refit {
  double p_below = 0.05;        ///< p-value of the plain fit from which on it is enough
  scattering_tail tail{};
  double stray_share = 0.003;   ///< measurements that are not of the track
  double stray_variance = 9.0;  ///< mm^2, of those about the track

  /// Memory, to be handed in again.
  template <class StateSpace>
  struct buffers {
    static constexpr int dimension = StateSpace::dimension;
    fit_memory<StateSpace, double, leg> plain;  ///< stops of the plain fit, and its states to linearise about
    struct stop {
      std::optional<weighted_leg> step;
      std::optional<fibre_measurement<StateSpace>> measurement;
    };
    std::vector<stop> stops;
    std::vector<kalman::node<double, dimension, 1>> nodes;
    std::vector<kalman::estimate<double, dimension>> mean;  ///< the outcome, for each site
    double sum = 0.0;                                       ///< of the weights, relative to the likeliest so far
    double likeliest = 0.0;                                 ///< logarithm
  };

  /// Mixes the smoothed estimates of all reasons into `work.mean`, one for each of `sites` (steps: optional references to legs of `path`; measurements: optional). False
  /// where not even the plain reason could be fitted.
  template <class StateSpace, class Filter, class Estimate, class Sites, class References>
  [[nodiscard]] bool operator()(const Filter& filter, const fit_path& path, const Estimate& start, const Sites& sites, const References& references,
                                buffers<StateSpace>& work) const {
    const kalman::filter hypothesis(weighted_propagator{filter.propagator()}, weighted_noise{filter.noise()});
    work.stops.clear();
    for (const auto& s : sites) {
      work.stops.push_back({});
      if (s.measurement) work.stops.back().measurement = *s.measurement;
      if (s.step) work.stops.back().step = weighted_leg{*s.step};
    }
    work.nodes.resize(sites.size());
    work.mean.resize(sites.size());
    work.sum = 0.0;

    int first = 0;  // stations with a measurement, in the order of the way
    int last = 0;
    for (std::size_t i = 0; i < path.surfaces.size(); ++i) {
      if (!work.stops[i].measurement) continue;
      if (first == 0) first = path.surfaces[i].station;
      last = path.surfaces[i].station;
    }
    const double nothing = std::log(tail.share[0]);
    const auto inner = [&](int station) { return station != first && station != last; };
    for_each_station(path, [&](int station) {
      if (inner(station)) weigh(path, station, tail.variance[0], work);
    });
    const bool plain = try_one(hypothesis, start, references, 0.0, work);
    for_each_station(path, [&](int station) {
      if (!inner(station)) return;
      for (std::size_t i = 1; i < tail.share.size(); ++i) {
        weigh(path, station, tail.variance[i], work);
        (void)try_one(hypothesis, start, references, std::log(tail.share[i]) - nothing, work);
      }
      weigh(path, station, tail.variance[0], work);
    });
    for (auto& s : work.stops) {
      if (!s.measurement) continue;
      const double usual = s.measurement->alpha_variance;
      s.measurement->alpha_variance = std::max(usual, stray_variance);
      (void)try_one(hypothesis, start, references, std::log(stray_share), work);
      s.measurement->alpha_variance = usual;
    }
    return plain && work.sum > 0.0;
  }

 private:
  template <class F>
  static void for_each_station(const fit_path& path, const F& f) {
    int before = 0;
    for (const surface& s : path.surfaces) {
      if (s.station != before) f(s.station);
      before = s.station;
    }
  }

  /// Gives the material of a station this weight: at the end of the legs that lead to its surfaces, at the start of those that leave them.
  template <class Work>
  static void weigh(const fit_path& path, int station, double weight, Work& work) {
    for (std::size_t i = 0; i < work.stops.size(); ++i) {
      if (!work.stops[i].step) continue;
      if (i < path.surfaces.size() && path.surfaces[i].station == station) work.stops[i].step->finish = weight;
      if (i > 0 && path.surfaces[i - 1].station == station) work.stops[i].step->start = weight;
    }
  }

  /// Fits one reason and mixes it in with its weight.
  template <class Filter, class Estimate, class References, class Work>
  static bool try_one(const Filter& filter, const Estimate& start, const References& references, double log_prior, Work& work) {
    const auto result = filter.run(start, work.stops, work.nodes, references);
    if (!result.status.ok() || !kalman::smooth(work.nodes).ok()) return false;
    double weight = log_prior;
    for (const auto& n : work.nodes)
      if (n.measurement_dimension > 0) weight -= 0.5 * (n.chi2 + std::log(n.residual_covariance(0, 0)));
    if (!std::isfinite(weight)) return false;
    if (!(work.sum > 0.0)) work.likeliest = weight;
    if (weight > work.likeliest) {
      work.sum *= std::exp(work.likeliest - weight);
      work.likeliest = weight;
    }
    const double own = std::exp(weight - work.likeliest);
    work.sum += own;
    const double share = own / work.sum;
    for (std::size_t i = 0; i < work.nodes.size(); ++i) {
      const auto& one = work.nodes[i].smoothed;
      auto& all = work.mean[i];
      if (share == 1.0) {
        all = one;
        continue;
      }
      const auto away = (one.mean - all.mean).eval();
      all.covariance = ((1.0 - share) * all.covariance + share * one.covariance + share * (1.0 - share) * away * away.transpose()).eval();
      all.mean += share * away;
    }
    return true;
  }
};

/// Has the second look that a policy wants at a track that was fitted plainly from `start`: replaces its states and the charge, or leaves it as it is.
///
/// A policy has `p_below`, `buffers<StateSpace>` with the `plain` memory and the `mean` it leaves, and the call of robust_refit.
/// `from_slopes` and `to_slopes` convert between slope_state and the state of the fit: a vector, and an estimate.
template <class StateSpace, class Refit, class Filter, class FromSlopes, class ToSlopes>
void look_again(const Refit& refit, const Filter& filter, const fit_path& path, int travel, const kalman::estimate<double, StateSpace::dimension>& start, const fit_job& job,
                const FromSlopes& from_slopes, const ToSlopes& to_slopes, typename Refit::template buffers<StateSpace>& work, fitted_track& out) {
  if (!out.summary.status.ok() || !(out.summary.p_value < refit.p_below)) return;
  const std::size_t surfaces = path.surfaces.size();
  set_stops(path, path.legs, std::array{job}, work.plain);
  auto& references = work.plain.references;
  references.resize(surfaces + 2);
  for (std::size_t i = 0; i < surfaces; ++i) references[i + 1] = from_slopes(out.points[surfaces - 1 - i].smoothed.mean);
  references[0] = references[1];
  references[surfaces + 1] = from_slopes(momentum_to_slopes(out.summary.reference.mean, out.summary.charge).state);
  if (!refit(filter, path, start, work.plain.stops, references, work)) return;
  for (std::size_t i = 0; i < surfaces; ++i) out.points[surfaces - 1 - i].smoothed = to_slopes(work.mean[i]);
  const kalman::estimate<double, 5> at_reference = to_slopes(work.mean[surfaces]);
  out.summary.charge = (at_reference.mean[slope_state::q_over_pz] < 0.0 ? -1 : 1) * travel;
  out.summary.reference = convert(at_reference, [travel](const vector<double, 5>& x) { return slopes_to_momentum(x, travel); });
}

}  // namespace scifi
