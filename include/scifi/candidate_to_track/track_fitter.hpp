// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <vector>

#include <scifi/candidate_to_track/fit_memory.hpp>
#include <scifi/candidate_to_track/fit_path.hpp>
#include <scifi/candidate_to_track/fit_probability.hpp>
#include <scifi/candidate_to_track/fit_stops.hpp>
#include <scifi/candidate_to_track/robust_refit.hpp>
#include <scifi/candidate_to_track/write_track.hpp>
#include <scifi/core/lane.hpp>
#include <scifi/core/pack_math.hpp>
#include <scifi/core/refuse.hpp>
#include <scifi/event/candidate.hpp>
#include <scifi/event/cluster.hpp>
#include <scifi/event/space_point.hpp>
#include <scifi/event/track.hpp>
#include <scifi/kalman/bryson_frazier.hpp>
#include <scifi/kalman/relinearised.hpp>
#include <scifi/kalman/site.hpp>
#include <scifi/kalman/symmetric_form.hpp>
#include <scifi/track_model/conversions.hpp>
#include <scifi/track_model/energy_loss_propagator.hpp>
#include <scifi/track_model/fibre_measurement.hpp>
#include <scifi/track_model/helix_propagator.hpp>
#include <scifi/track_model/line_propagator.hpp>
#include <scifi/track_model/material_noise.hpp>
#include <scifi/track_model/prepared_leg.hpp>
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
/// `Flight` carries a bent track in vacuum: the helix of `options.field`, or a nystrom_propagator in any field. `fit_batch` fits many at once, one in
/// each SIMD lane. `Refit` (robust_refit) may have a second look at a track that fits badly, `Probability` says how badly. Const, shared between threads.
/// A tracker without planes is refused with std::invalid_argument.
template <class EnergyLoss, class Scattering, class Straggling, class Update = kalman::symmetric_form, class Gate = kalman::no_gate, class Flight = helix_propagator,
          class Refit = no_refit, class Probability = gaussian_probability>
class track_fitter {
 public:
  using helix_filter = kalman::filter<energy_loss_propagator<Flight, EnergyLoss>, material_noise<Scattering, Straggling>, Update, Gate>;
  using line_filter = kalman::filter<leg_propagator<line_propagator>, line_material_noise<Scattering>, Update, Gate>;
  using helix_leg = prepared_leg<EnergyLoss, Scattering, Straggling>;
  /// The numbers of a batch: one track a lane.
  using lanes = pack<double>;

  track_fitter(const tracker& where, const track_fit_options& options, const particle& hypothesis, EnergyLoss loss, Scattering scattering, Straggling straggling,
               Update update = {}, Gate gate = {})
    requires std::same_as<Flight, helix_propagator>
      : track_fitter(where, options, hypothesis, loss, scattering, straggling, update, gate, helix_propagator{options.field}) {}

  /// With a flight of one's own, in the tracker frame; `options.field` then serves only the seed, on its short way from the candidate to the first surface.
  track_fitter(const tracker& where, const track_fit_options& options, const particle& hypothesis, EnergyLoss loss, Scattering scattering, Straggling straggling,
               Update update, Gate gate, Flight flight, Refit refit = {}, Probability probability = {})
      : options_(options),
        refit_(refit),
        probability_(probability),
        travel_(where.beam_direction),
        path_(with_planes(fit_path_of(where))),
        helix_({flight, loss, hypothesis, where.beam_direction}, {scattering, straggling, hypothesis}, update, gate),
        line_({{}}, {scattering, hypothesis, options.line_momentum}, update, gate) {
    for (const leg& l : path_.legs) helix_legs_.emplace_back(l, loss, scattering, straggling, hypothesis);
  }

  /// Working memory, to be handed in again.
  struct buffers {
    fit_memory<slope_state, double, helix_leg> helix;
    fit_memory<slope_state, lanes, helix_leg> helices;
    fit_memory<line_state, double, leg> line;
    fitted_track one;
    std::vector<std::size_t> in_lanes;
    typename Refit::template buffers<slope_state> helix_again;
    typename Refit::template buffers<line_state> line_again;
  };

  /// Fits one candidate; appends its track and its track points. A failed fit is appended too, with its status and no points.
  void operator()(const candidate& c, int candidate_index, std::span<const space_point> points, std::span<const cluster> clusters, std::vector<track>& tracks,
                  std::vector<track_point>& track_points, buffers& work) const {
    fit_one({&c, candidate_index, points, clusters}, work.one, work);
    append(work.one, tracks, track_points);
  }

  /// Fits candidates of any events; out[i] becomes the track of jobs[i], as one fitted alone up to rounding, with `first_point` left zero. `out` grows if need be.
  ///
  /// Bent ones go in packs as wide as the machine's vectors; straight ones, what is left over and any that fails in its lane are fitted one by one.
  void fit_batch(std::span<const fit_job> jobs, std::vector<fitted_track>& out, buffers& work) const {
    if (out.size() < jobs.size()) out.resize(jobs.size());
    work.in_lanes.clear();
    for (std::size_t i = 0; i < jobs.size(); ++i) {
      if (lanes_agree && jobs[i].from->shape == track_shape::helix) work.in_lanes.push_back(i);
      else fit_one(jobs[i], out[i], work);
    }
    constexpr std::size_t width = static_cast<std::size_t>(lanes::lanes);
    std::size_t done = 0;
    if constexpr (lanes_agree) {
      for (; done + width <= work.in_lanes.size(); done += width) {
        std::array<fit_job, width> together;
        std::array<fitted_track*, width> fitted;
        for (std::size_t lane = 0; lane < width; ++lane) {
          together[lane] = jobs[work.in_lanes[done + lane]];
          fitted[lane] = &out[work.in_lanes[done + lane]];
        }
        fit_helices(together, fitted, work.helices);
        for (std::size_t lane = 0; lane < width; ++lane) {
          if (fitted[lane]->summary.status.ok()) look_at_helix_again(together[lane], *fitted[lane], work);
          else fit_one(together[lane], *fitted[lane], work);
        }
      }
    }
    for (; done < work.in_lanes.size(); ++done) fit_one(jobs[work.in_lanes[done]], out[work.in_lanes[done]], work);
  }

  [[nodiscard]] const track_fit_options& options() const { return options_; }
  [[nodiscard]] const fit_path& path() const { return path_; }
  [[nodiscard]] const helix_filter& helix() const { return helix_; }
  [[nodiscard]] const line_filter& line() const { return line_; }

 private:
  /// A flight that chooses its steps would choose them for all lanes together, and a track would depend on its neighbours.
  static constexpr bool lanes_agree = std::same_as<Flight, helix_propagator>;

  [[nodiscard]] static fit_path with_planes(fit_path path) {
    if (path.surfaces.empty()) detail::refuse<std::invalid_argument>("scifi: a tracker without planes has nothing to fit a track to");
    return path;
  }

  void fit_one(const fit_job& job, fitted_track& out, buffers& work) const {
    if (job.from->shape == track_shape::helix) {
      fit_helices(std::array{job}, std::array{&out}, work.helix);
      return look_at_helix_again(job, out, work);
    }
    const vector<double, 5> seed = seed_of(*job.from);
    const vector<double, 4> line = slopes_to_line(seed).state;
    const double k = seed[slope_state::q_over_pz];
    const auto to_slopes = [k](const auto& e) { return convert(e, [k](const vector<double, 4>& x) { return line_to_slopes(x, k); }); };
    fit(line_, path_.legs, wide<line_state>(line), line, std::array{job}, std::array{&out}, work.line, [](const auto&, const auto&) { return true; }, to_slopes);  // a line is linear
    if constexpr (!std::same_as<Refit, no_refit>)
      look_again<line_state>(refit_, line_, path_, travel_, wide<line_state>(line), job, [](const vector<double, 5>& s) { return slopes_to_line(s).state; }, to_slopes, work.line_again, out);
  }

  void look_at_helix_again([[maybe_unused]] const fit_job& job, [[maybe_unused]] fitted_track& out, [[maybe_unused]] buffers& work) const {
    if constexpr (!std::same_as<Refit, no_refit>) {
      const auto same = [](const auto& s) { return s; };
      look_again<slope_state>(refit_, helix_, path_, travel_, helix_start(seed_of(*job.from)), job, same, same, work.helix_again, out);
    }
  }

  template <std::size_t Width, class Scalar>
  void fit_helices(const std::array<fit_job, Width>& jobs, const std::array<fitted_track*, Width>& out, fit_memory<slope_state, Scalar, helix_leg>& work) const {
    vector<Scalar, 5> seed;
    for (std::size_t lane = 0; lane < Width; ++lane) {
      const vector<double, 5> one = seed_of(*jobs[lane].from);
      for (int i = 0; i < 5; ++i) set_lane(seed[i], static_cast<int>(lane), one[i]);
    }
    const auto settled = [this](const auto& reference, const auto& smoothed) {
      constexpr int k = slope_state::q_over_pz;
      const Scalar share = Scalar(options_.settled) * magnitude(reference[k]);
      return magnitude(Scalar(smoothed.mean[k] - reference[k])) <= share && kalman::sigma(smoothed, k) <= Scalar(2.0) * share;
    };
    fit(helix_, helix_legs_, helix_start(seed), seed, jobs, out, work, settled, [](const auto& e) { return e; });
  }

  /// The seed flown to the last surface.
  [[nodiscard]] vector<double, 5> seed_of(const candidate& c) const {
    return helix_propagator{c.shape == track_shape::helix ? options_.field : 0.0}.propagate(c.seed.mean, path_.surfaces.front().z - c.z).state;
  }

  /// The seed as a mean, with a covariance that leaves everything to the data.
  template <class StateSpace, class Scalar, int N = StateSpace::dimension>
  [[nodiscard]] kalman::estimate<Scalar, N> wide(const vector<Scalar, N>& seed) const {
    kalman::estimate<Scalar, N> e{seed, matrix<Scalar, N, N>::Zero()};
    for (const int i : {StateSpace::x, StateSpace::y}) e.covariance(i, i) = Scalar(options_.position_spread * options_.position_spread);
    for (const int i : {StateSpace::tx, StateSpace::ty}) e.covariance(i, i) = Scalar(options_.slope_spread * options_.slope_spread);
    return e;
  }

  /// The same for a helix, q/pz as the prior has it with the sign of the seed.
  template <class Scalar>
  [[nodiscard]] kalman::estimate<Scalar, 5> helix_start(const vector<Scalar, 5>& seed) const {
    constexpr int k = slope_state::q_over_pz;
    kalman::estimate<Scalar, 5> start = wide<slope_state>(seed);
    start.mean[k] = select(seed[k] < Scalar(0.0), Scalar(-options_.prior.typical), Scalar(options_.prior.typical));
    start.covariance(k, k) = Scalar(options_.prior.spread * options_.prior.spread);
    return start;
  }

  template <class Filter, class StateSpace, class Scalar, class Leg, std::size_t Width, class Settled, class ToSlopes>
  void fit(const Filter& filter, const std::vector<Leg>& legs, const kalman::estimate<Scalar, StateSpace::dimension>& start, const vector<Scalar, StateSpace::dimension>& seed,
           const std::array<fit_job, Width>& jobs, const std::array<fitted_track*, Width>& out, fit_memory<StateSpace, Scalar, Leg>& work, const Settled& settled,
           const ToSlopes& to_slopes) const {
    const std::size_t surfaces = path_.surfaces.size();
    set_stops(path_, legs, jobs, work);
    work.nodes.resize(surfaces + 1);
    work.references.resize(surfaces + 2);
    // A lane that has settled is written out at once: another pass, made for the others, would move it.
    std::array<bool, Width> written{};
    const auto write = [&](const auto& ready) {
      for (std::size_t lane = 0; lane < Width; ++lane) {
        if (written[lane] || !lane_of(ready, static_cast<int>(lane))) continue;
        written[lane] = true;
        write_track(path_, travel_, work, jobs[lane], lane, to_slopes, *out[lane], probability_);
      }
    };
    const auto result = kalman::run_relinearised(
        filter, start, seed, work.stops, work.nodes, work.references, options_.passes,
        [&](const auto& reference, const auto& smoothed) {
          const auto ready = settled(reference, smoothed);
          if constexpr (Width > 1) write(ready);
          return all_of(ready);
        },
        kalman::modified_bryson_frazier{});
    if (result.status.ok()) return write(kalman::mask<Scalar>(true));
    for (std::size_t lane = 0; lane < Width; ++lane)
      if (!written[lane]) write_failure(path_, jobs[lane], result.status, *out[lane]);
  }

  track_fit_options options_;
  [[no_unique_address]] Refit refit_;
  [[no_unique_address]] Probability probability_;
  int travel_;
  fit_path path_;
  std::vector<helix_leg> helix_legs_;
  helix_filter helix_;
  line_filter line_;
};

}  // namespace scifi
