// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include <scifi/alignment/failure.hpp>
#include <scifi/alignment/track_equations.hpp>
#include <scifi/alignment/track_linearisation.hpp>
#include <scifi/alignment/tracker_parameters.hpp>
#include <scifi/candidate_to_track/fit_path.hpp>
#include <scifi/event/event.hpp>
#include <scifi/track_model/line_state.hpp>
#include <scifi/track_model/q_over_pz_prior.hpp>
#include <scifi/track_model/slope_state.hpp>

namespace scifi::alignment {

/// A fitted track as equations for the alignment of its tracker: with the propagator, the noise, the material and the prior of the fit, linearised about
/// its smoothed states. Straight tracks have four parameters of their own, helices five.
template <class Fitter>
class fit_equations {
 public:
  explicit fit_equations(const Fitter& fit)
      : path_(fit.path()),
        prior_(fit.options().prior),
        helix_(fit.helix().propagator(), fit.helix().noise()),
        line_(fit.line().propagator(), fit.line().noise()) {}

  /// Working memory of tracks with N parameters.
  template <class Linearisation, int N>
  struct lane {
    std::vector<vector<double, N>> reference;
    std::vector<stop_measurement<N>> measurements;
    typename Linearisation::buffers work;
  };

 private:
  template <class Filter, int N>
  using linearisation = track_linearisation<std::remove_cvref_t<decltype(std::declval<const Filter&>().propagator())>,
                                            std::remove_cvref_t<decltype(std::declval<const Filter&>().noise())>, N>;
  using helix_linearisation = linearisation<typename Fitter::helix_filter, slope_state::dimension>;
  using line_linearisation = linearisation<typename Fitter::line_filter, line_state::dimension>;

 public:
  /// Working memory, to be handed in again.
  struct buffers {
    lane<helix_linearisation, slope_state::dimension> helix;
    lane<line_linearisation, line_state::dimension> line;
    std::vector<motion_derivatives> global;
  };

  /// Replaces `out` by the equations of a track of `e` that was fitted in the geometry of `parameters` by the fitter given.
  [[nodiscard]] failure operator()(const tracker_parameters& parameters, const event& e, const track& t, track_equations& out, buffers& work) const {
    if (!t.status.ok() || static_cast<std::size_t>(t.points) != path_.surfaces.size()) return failure::too_few_measurements;
    if (t.shape == track_shape::line) return make<line_state>(line_, parameters, e, t, out, work.line, work.global);
    const failure why = make<slope_state>(helix_, parameters, e, t, out, work.helix, work.global);
    // The fit starts from a prior of q/pz, without which a track that the field does not bend would have none.
    const double k = work.helix.reference.front()[slope_state::q_over_pz];
    std::array<double, slope_state::dimension> local{};
    local[slope_state::q_over_pz] = 1.0;
    out.add_wide_prior(std::copysign(prior_.typical, k) - k, prior_.spread, local);
    return why;
  }

 private:
  template <class StateSpace, class Linearisation, class Lane>
  [[nodiscard]] failure make(const Linearisation& linearise, const tracker_parameters& parameters, const event& e, const track& t, track_equations& out, Lane& work,
                             std::vector<motion_derivatives>& global) const {
    constexpr int N = StateSpace::dimension;
    out.clear(N);
    const std::size_t sites = path_.surfaces.size();
    work.reference.clear();
    work.measurements.clear();
    global.resize(sites);
    for (std::size_t i = 0; i < sites; ++i) {
      // The path goes against z, the points of a track along it.
      const track_point& point = e.track_points[static_cast<std::size_t>(t.first_point) + sites - 1 - i];
      const vector<double, slope_state::dimension>& state = point.smoothed.mean;
      work.reference.push_back(state.head<N>());
      if (point.cluster < 0 || point.outlier) continue;
      const surface& at = path_.surfaces[i];
      const cluster& hit = e.clusters[static_cast<std::size_t>(point.cluster)];
      const double x = state[slope_state::x];
      const double y = state[slope_state::y];
      global[i] = parameters.derivatives(at, x, y);
      stop_measurement<N> m;
      m.site = static_cast<int>(i);
      m.residual = hit.alpha - at.tracker_to_alpha(x, y);
      m.variance = hit.variance;
      m.projection(StateSpace::x) = at.cos_angle;
      m.projection(StateSpace::y) = at.sin_angle;
      m.global = {global[i].begin(), global[i].size()};
      work.measurements.push_back(m);
    }
    return linearise(work.reference, path_.legs, work.measurements, out, work.work);
  }

  fit_path path_;
  q_over_pz_prior prior_;
  helix_linearisation helix_;
  line_linearisation line_;
};

}  // namespace scifi::alignment
