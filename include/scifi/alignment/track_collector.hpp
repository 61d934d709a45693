// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <utility>

#include <scifi/alignment/chi2_scale.hpp>
#include <scifi/alignment/fit_equations.hpp>
#include <scifi/alignment/local_elimination.hpp>
#include <scifi/alignment/normal_equations.hpp>
#include <scifi/alignment/tracker_parameters.hpp>
#include <scifi/core/chi_squared.hpp>
#include <scifi/event/event.hpp>

namespace scifi::alignment {

/// Which tracks an alignment takes.
struct track_cuts {
  int min_planes = 12;          ///< measurements used in the fit
  double min_p_value = 0.001;   ///< of chi2 / chi2_scale: takes out hard scatters and wrong clusters
  /// Largest relative error of q/pz of a helix. Where the field hardly bends a track its scattering is known as badly as its momentum, and a linear
  /// treatment states too small errors.
  double max_curvature_error = 0.05;
  double chi2_scale = 0.0;      ///< by how much all chi2 are expected to be too large; 0: not known yet, no cut on the probability
};

/// What a pass over the events gathers for one tracker. Sums over parts of the events are added.
struct tracker_sum {
  explicit tracker_sum(int parameters) : equations(parameters) {}
  normal_equations equations;
  alignment::chi2_scale scale;
  long incomplete = 0;  ///< tracks with too few planes
  long unbent = 0;      ///< helices whose q/pz is too badly known
  long improbable = 0;  ///< taken out by their chi2
  long failed = 0;      ///< could not be linearised

  tracker_sum& operator+=(const tracker_sum& more) {
    equations += more.equations;
    scale += more.scale;
    incomplete += more.incomplete;
    unbent += more.unbent;
    improbable += more.improbable;
    failed += more.failed;
    return *this;
  }
};

/// Takes the tracks of one tracker from reconstructed events into its normal equations. Const, shared between threads.
template <class Fitter>
class track_collector {
 public:
  /// `fit` is what fitted the tracks, in the geometry of `parameters`.
  track_collector(tracker_parameters parameters, const Fitter& fit, const track_cuts& cuts) : parameters_(std::move(parameters)), equations_(fit), cuts_(cuts) {}

  /// Working memory, to be handed in again.
  struct buffers {
    typename fit_equations<Fitter>::buffers fit;
    track_equations track;
    local_elimination eliminate;
    reduced_track reduced;
  };

  [[nodiscard]] tracker_sum empty() const { return tracker_sum(parameters_.size()); }

  void operator()(const event& e, tracker_sum& sum, buffers& work) const {
    for (const track& t : e.tracks) {
      if (t.tracker != parameters_.where().id || !t.status.ok()) continue;
      if (t.planes < cuts_.min_planes) {
        ++sum.incomplete;
        continue;
      }
      if (curvature_error(e, t) > cuts_.max_curvature_error) {
        ++sum.unbent;
        continue;
      }
      failure why = equations_(parameters_, e, t, work.track, work.fit);
      if (why == failure::none) {
        work.eliminate(work.track, parameters_.size(), work.reduced);
        why = work.reduced.status;
      }
      if (why != failure::none) {
        ++sum.failed;
        continue;
      }
      sum.scale.add(work.reduced.chi2, work.reduced.ndf);
      if (cuts_.chi2_scale > 0.0 && !(chi_squared_probability(work.reduced.chi2 / cuts_.chi2_scale, work.reduced.ndf) >= cuts_.min_p_value)) ++sum.improbable;
      else sum.equations.add(work.reduced);
    }
  }

 private:
  /// Relative, at the station farthest from the reference surface; zero for a straight track.
  [[nodiscard]] static double curvature_error(const event& e, const track& t) {
    if (t.shape == track_shape::line || t.points == 0) return 0.0;
    const auto& at = e.track_points[static_cast<std::size_t>(t.first_point + t.points - 1)].smoothed;
    return kalman::sigma(at, slope_state::q_over_pz) / std::abs(at.mean[slope_state::q_over_pz]);
  }

  tracker_parameters parameters_;
  fit_equations<Fitter> equations_;
  track_cuts cuts_;
};

}  // namespace scifi::alignment
