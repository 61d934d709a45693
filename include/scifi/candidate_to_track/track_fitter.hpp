// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

#include <scifi/candidate_to_track/fit_path.hpp>
#include <scifi/core/chi_squared.hpp>
#include <scifi/event/candidate.hpp>
#include <scifi/event/cluster.hpp>
#include <scifi/event/space_point.hpp>
#include <scifi/event/track.hpp>
#include <scifi/kalman/node_residual.hpp>
#include <scifi/kalman/relinearised.hpp>
#include <scifi/kalman/site.hpp>
#include <scifi/track_model/conversions.hpp>
#include <scifi/track_model/energy_loss_propagator.hpp>
#include <scifi/track_model/fibre_measurement.hpp>
#include <scifi/track_model/helix_propagator.hpp>
#include <scifi/track_model/line_propagator.hpp>
#include <scifi/track_model/material_noise.hpp>
#include <scifi/track_model/q_over_pz_prior.hpp>

namespace scifi {

/// What the track fit assumes before it sees a measurement, and how often it linearises.
struct track_fit_options {
  double field = 0.0;                ///< Bz in the tracker frame, (MeV/c)/(e mm)
  double line_momentum = 200.0;      ///< MeV/c, of straight tracks: sets their scattering
  int passes = 2;                    ///< at most: the first is linearised about the seed, each further one about the smoothed track before
  double settled = 0.01;             ///< no further pass where q/pz changed by less than this share, and is known to twice it
  double position_spread = 50.0;     ///< mm, about the seed: wide, the data decide
  double slope_spread = 0.5;         ///< about the seed
  q_over_pz_prior prior{};           ///< with the sign of the seed
};

/// Candidates to tracks: a Kalman filter over their clusters, one coordinate each, from the last station to the reference surface at station 1, and a smoother.
///
/// All material and the policies given act between the surfaces. Linearised about a reference track, so that the first, badly known slopes do no harm.
/// `Flight` carries a bent track in vacuum: the helix of `options.field`, or a nystrom_propagator in any field. Const, shared between threads.
template <class EnergyLoss, class Scattering, class Straggling, class Update = kalman::joseph, class Gate = kalman::no_gate, class Flight = helix_propagator>
class track_fitter {
 public:
  using helix_filter = kalman::filter<energy_loss_propagator<Flight, EnergyLoss>, material_noise<Scattering, Straggling>, Update, Gate>;
  using line_filter = kalman::filter<leg_propagator<line_propagator>, line_material_noise<Scattering>, Update, Gate>;

  track_fitter(const tracker& where, const track_fit_options& options, const particle& hypothesis, EnergyLoss loss, Scattering scattering, Straggling straggling,
               Update update = {}, Gate gate = {})
    requires std::same_as<Flight, helix_propagator>
      : track_fitter(where, options, hypothesis, loss, scattering, straggling, update, gate, helix_propagator{options.field}) {}

  /// With a flight of one's own, in the tracker frame; `options.field` then serves only the seed, on its short way from the candidate to the first surface.
  track_fitter(const tracker& where, const track_fit_options& options, const particle& hypothesis, EnergyLoss loss, Scattering scattering, Straggling straggling,
               Update update, Gate gate, Flight flight)
      : options_(options),
        travel_(where.beam_direction),
        path_(fit_path_of(where)),
        helix_({flight, loss, hypothesis, where.beam_direction}, {scattering, straggling, hypothesis}, update, gate),
        line_({{}}, {scattering, hypothesis, options.line_momentum}, update, gate) {}

  /// One surface of the way and what was measured there.
  template <class StateSpace>
  struct stop {
    std::optional<std::reference_wrapper<const leg>> step;
    std::optional<fibre_measurement<StateSpace>> measurement;
  };

  /// Working memory of one state space.
  template <class StateSpace>
  struct lane {
    std::vector<stop<StateSpace>> stops;
    std::vector<kalman::node<double, StateSpace::dimension, 1>> nodes;
    std::vector<vector<double, StateSpace::dimension>> references;
  };

  /// Working memory, to be handed in again.
  struct buffers {
    lane<slope_state> helix;
    lane<line_state> line;
    std::vector<int> cluster_at;  // per surface, -1: none
  };

  /// Fits one candidate; appends its track and its track points. A failed fit is appended too, with its status and no points.
  void operator()(const candidate& c, int candidate_index, std::span<const space_point> points, std::span<const cluster> clusters, std::vector<track>& tracks,
                  std::vector<track_point>& track_points, buffers& work) const {
    assign(c, points, clusters, work.cluster_at);
    track t;
    t.tracker = c.tracker;
    t.candidate = candidate_index;
    t.shape = c.shape;
    t.z = path_.z_reference;
    t.first_point = static_cast<int>(track_points.size());
    const double dz = path_.surfaces.front().z - c.z;
    const vector<double, 5> seed = helix_propagator{c.shape == track_shape::helix ? options_.field : 0.0}.propagate(c.seed.mean, dz).state;
    const double k = seed[slope_state::q_over_pz];

    if (c.shape == track_shape::helix) {
      kalman::estimate<double, 5> start = wide<slope_state>(seed);
      start.mean[slope_state::q_over_pz] = std::copysign(options_.prior.typical, k);
      start.covariance(slope_state::q_over_pz, slope_state::q_over_pz) = options_.prior.spread * options_.prior.spread;
      fit<slope_state>(helix_, start, seed, clusters, t, track_points, work.helix, work.cluster_at, [](const auto& e) { return e; });
    } else {
      const vector<double, 4> line = slopes_to_line(seed).state;
      fit<line_state>(line_, wide<line_state>(line), line, clusters, t, track_points, work.line, work.cluster_at,
                      [k](const auto& e) { return convert(e, [k](const vector<double, 4>& x) { return line_to_slopes(x, k); }); });
    }
    tracks.push_back(t);
  }

 private:
  /// Which cluster stands at which surface.
  void assign(const candidate& c, std::span<const space_point> points, std::span<const cluster> clusters, std::vector<int>& cluster_at) const {
    cluster_at.assign(path_.surfaces.size(), -1);
    for (const int point : c.space_points) {
      for (const int member : points[static_cast<std::size_t>(point)].clusters) {
        const cluster& hit = clusters[static_cast<std::size_t>(member)];
        for (std::size_t i = 0; i < path_.surfaces.size(); ++i)
          if (path_.surfaces[i].station == hit.station && path_.surfaces[i].plane == hit.plane) cluster_at[i] = member;
      }
    }
  }

  /// The seed as a mean, with a covariance that leaves everything to the data.
  template <class StateSpace, int N = StateSpace::dimension>
  [[nodiscard]] kalman::estimate<double, N> wide(const vector<double, N>& seed) const {
    kalman::estimate<double, N> e{seed, matrix<double, N, N>::Zero()};
    for (const int i : {StateSpace::x, StateSpace::y}) e.covariance(i, i) = options_.position_spread * options_.position_spread;
    for (const int i : {StateSpace::tx, StateSpace::ty}) e.covariance(i, i) = options_.slope_spread * options_.slope_spread;
    return e;
  }

  template <class StateSpace, class Filter, class ToSlopes>
  void fit(const Filter& filter, const kalman::estimate<double, StateSpace::dimension>& start, const vector<double, StateSpace::dimension>& seed,
           std::span<const cluster> clusters, track& t, std::vector<track_point>& track_points, lane<StateSpace>& work, const std::vector<int>& cluster_at,
           const ToSlopes& to_slopes) const {
    const std::size_t surfaces = path_.surfaces.size();
    work.stops.clear();
    for (std::size_t i = 0; i <= surfaces; ++i) {
      stop<StateSpace> s{kalman::at_start, std::nullopt};
      if (i > 0) s.step = path_.legs[i];
      if (i < surfaces && cluster_at[i] >= 0) {
        const surface& at = path_.surfaces[i];
        const cluster& hit = clusters[static_cast<std::size_t>(cluster_at[i])];
        s.measurement = fibre_measurement<StateSpace>{hit.alpha, hit.variance, at.cos_angle, at.sin_angle, at.offset};
      }
      work.stops.push_back(s);
    }
    work.nodes.resize(surfaces + 1);
    work.references.resize(surfaces + 2);
    const auto result = kalman::run_relinearised(filter, start, seed, work.stops, work.nodes, work.references, options_.passes, [&](const auto& reference, const auto& smoothed) {
      if constexpr (std::is_same_v<StateSpace, line_state>) return true;  // a line is linear
      else {
        constexpr int k = slope_state::q_over_pz;
        const double share = options_.settled * std::abs(reference[k]);
        return std::abs(smoothed.mean[k] - reference[k]) <= share && kalman::sigma(smoothed, k) <= 2.0 * share;
      }
    });
    t.status = result.status;
    if (!result.status.ok()) return;

    t.chi2 = result.chi2;
    t.ndf = result.ndf - (t.shape == track_shape::helix ? 5 : 4);
    t.p_value = chi_squared_probability(t.chi2, t.ndf);
    const kalman::estimate<double, 5> at_reference = to_slopes(work.nodes.back().smoothed);
    t.charge = (at_reference.mean[slope_state::q_over_pz] < 0.0 ? -1 : 1) * travel_;
    t.reference = convert(at_reference, [this](const vector<double, 5>& x) { return slopes_to_momentum(x, travel_); });
    for (std::size_t i = surfaces; i-- > 0;) add_point(work.nodes[i], path_.surfaces[i], cluster_at[i], t, track_points, to_slopes);
  }

  template <class Node, class ToSlopes>
  void add_point(const Node& n, const surface& at, int cluster, track& t, std::vector<track_point>& track_points, const ToSlopes& to_slopes) const {
    track_point p;
    p.station = at.station;
    p.plane = at.plane;
    p.z = at.z;
    p.smoothed = to_slopes(n.smoothed);
    p.residual = p.pull = std::numeric_limits<double>::quiet_NaN();
    if (n.measurement_dimension > 0) {
      const auto unbiased = kalman::unbiased_residual(n);
      p.residual = unbiased.value(0);
      p.pull = p.residual / std::sqrt(unbiased.covariance(0, 0));
      p.chi2 = n.chi2;
      p.outlier = n.outlier;
      p.cluster = cluster;
      if (!p.outlier) {
        const auto own = std::span(track_points).subspan(static_cast<std::size_t>(t.first_point));
        const bool seen = std::any_of(own.begin(), own.end(), [&at](const track_point& q) { return q.station == at.station && q.cluster >= 0 && !q.outlier; });
        t.stations += seen ? 0 : 1;
        ++t.planes;
      }
    }
    ++t.points;
    track_points.push_back(p);
  }

  track_fit_options options_;
  int travel_;
  fit_path path_;
  helix_filter helix_;
  line_filter line_;
};

}  // namespace scifi
