// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include <scifi/candidate_to_track/fit_path.hpp>
#include <scifi/geometry/tracker.hpp>
#include <scifi/information/fisher_information.hpp>
#include <scifi/information/plane_information.hpp>
#include <scifi/kalman/estimate.hpp>
#include <scifi/kalman/filter.hpp>
#include <scifi/material/energy_loss.hpp>
#include <scifi/material/particle.hpp>
#include <scifi/material/scattering.hpp>
#include <scifi/material/straggling.hpp>
#include <scifi/track_model/conversions.hpp>
#include <scifi/track_model/energy_loss_propagator.hpp>
#include <scifi/track_model/fibre_measurement.hpp>
#include <scifi/track_model/helix_propagator.hpp>
#include <scifi/track_model/material_noise.hpp>

namespace scifi {

/// The best that any unbiased fit can do at the reference surface of a tracker, for one true track.
struct reference_bound {
  kalman::estimate<double, 5> slopes;    ///< slope_state; the covariance is the bound, NaN where the measurements do not fix the state
  kalman::estimate<double, 5> momentum;  ///< momentum_state: x, y (mm), px, py, pz (MeV/c)
  double pt = std::numeric_limits<double>::quiet_NaN();  ///< standard deviation along the true direction of pt, MeV/c (along x where pt = 0)
  int planes = 0;                        ///< that measure
  [[nodiscard]] bool known() const { return std::isfinite(pt); }
};

/// Cramer-Rao bound of tracks at the reference surface of a tracker (z = 0, station 1) from geometry, material and field: no data, no fit.
///
/// The planes measure along the noise-free flight of the true state, each with the variance that the policy foresees there, as long as the track is inside the
/// active radius. Without a field q/pz is taken as known and its row and column of the bound are zero. Const, does not allocate, shared between threads.
template <class EnergyLoss, class Scattering, class Straggling, plane_information Resolution = doublet_information>
class track_bound {
 public:
  /// field: Bz in the tracker frame, (MeV/c)/(e mm). prior_q_over_pz: standard deviation of what is known of q/pz beforehand, e/(MeV/c); infinite: nothing.
  track_bound(const tracker& where, double field, const particle& hypothesis, EnergyLoss loss, Scattering scattering, Straggling straggling, Resolution resolution = {},
              double prior_q_over_pz = std::numeric_limits<double>::infinity())
      : field_(field),
        active_radius_(where.active_radius),
        prior_information_(1.0 / (prior_q_over_pz * prior_q_over_pz)),
        resolution_(resolution),
        forwards_({{field}, loss, hypothesis, +1}, {scattering, straggling, hypothesis}),
        backwards_({{field}, loss, hypothesis, -1}, {scattering, straggling, hypothesis}) {
    // The way of a fit, walked from its end.
    const fit_path path = fit_path_of(where);
    for (std::size_t i = path.surfaces.size(); i-- > 0;) {
      const surface& at = path.surfaces[i];
      const station* s = nullptr;
      for (const station& one : where.stations) s = one.id == at.station ? &one : s;
      leg step = path.legs[i + 1];
      step.dz = -step.dz;
      step.direction = -step.direction;
      std::swap(step.start, step.finish);
      places_.push_back({at, s->planes[static_cast<std::size_t>(at.plane)], step});
    }
  }

  /// Bound for the true state (momentum_state: x, y, px, py, pz at the reference surface) of a particle with this sign of charge.
  [[nodiscard]] reference_bound operator()(const vector<double, 5>& truth, int charge) const {
    return (*this)(truth, charge, [this](const plane& p, const surface& at, const vector<double, 5>& here) {
      const double alpha = at.tracker_to_alpha(here[slope_state::x], here[slope_state::y]);
      return std::optional<double>(resolution_.variance(p, alpha));
    });
  }

  /// The same for planes whose variance (mm^2) is known otherwise, such as those of the clusters a track has:
  /// seen(plane, surface, slope_state there) gives a std::optional, empty where nothing was measured.
  template <class Seen>
    requires std::is_invocable_r_v<std::optional<double>, const Seen&, const plane&, const surface&, const vector<double, 5>&>
  [[nodiscard]] reference_bound operator()(const vector<double, 5>& truth, int charge, const Seen& seen) const {
    const bool forwards = truth[momentum_state::pz] > 0.0;
    const vector<double, 5> slopes = momentum_to_slopes(truth, charge).state;
    gathered_information<double, 5> gathered(slopes);
    for (const place& next : places_) {
      gathered.move(forwards ? forwards_ : backwards_, next.step);
      const vector<double, 5>& here = gathered.state;
      if (!gathered.status.ok() || std::hypot(here[slope_state::x], here[slope_state::y]) > active_radius_) break;
      const surface& at = next.where;
      if (const std::optional<double> variance = seen(next.of, at, here))
        gathered.measure(fibre_measurement<slope_state>{0.0, *variance, at.cos_angle, at.sin_angle, at.offset});
    }
    return bound_of(slopes, gathered.information, gathered.measured, forwards ? 1 : -1);
  }

 private:
  struct place {
    surface where;
    plane of;
    leg step;  ///< that leads here
  };

  [[nodiscard]] reference_bound bound_of(const vector<double, 5>& slopes, matrix<double, 5, 5> information, int planes, int travel) const {
    using s = slope_state;
    using m = momentum_state;
    reference_bound out;
    out.planes = planes;
    information(s::q_over_pz, s::q_over_pz) += prior_information_;
    std::optional<matrix<double, 5, 5>> covariance;
    if (field_ != 0.0) {
      covariance = cramer_rao_bound<double, 5>(information);
    } else if (const auto line = cramer_rao_bound<double, 4>(information.topLeftCorner<4, 4>())) {
      covariance = matrix<double, 5, 5>::Zero();
      covariance->topLeftCorner<4, 4>() = *line;
    }
    out.slopes = {slopes, covariance.value_or(matrix<double, 5, 5>::Constant(std::numeric_limits<double>::quiet_NaN()))};
    out.momentum = convert(out.slopes, [travel](const vector<double, 5>& x) { return slopes_to_momentum(x, travel); });
    const double px = out.momentum.mean[m::px];
    const double py = out.momentum.mean[m::py];
    const double pt = std::hypot(px, py);
    const vector<double, 2> along = pt > 0.0 ? vector<double, 2>(px / pt, py / pt) : vector<double, 2>(1.0, 0.0);
    const matrix<double, 2, 2> transverse = out.momentum.covariance.block<2, 2>(m::px, m::px);
    out.pt = std::sqrt(along.dot(transverse * along));
    return out;
  }

  double field_, active_radius_, prior_information_;
  Resolution resolution_;
  using filter = kalman::filter<energy_loss_propagator<helix_propagator, EnergyLoss>, material_noise<Scattering, Straggling>>;
  filter forwards_, backwards_;
  std::vector<place> places_;
};

/// The bound with the physics of the standard chain (`make_reconstruction`): mean energy loss, straggling of the core over all stations, Highland's scattering.
template <plane_information Resolution = doublet_information>
[[nodiscard]] auto make_track_bound(const tracker& where, double field, const particle& hypothesis = muon_plus, Resolution resolution = {},
                                    double prior_q_over_pz = std::numeric_limits<double>::infinity()) {
  const double layers = static_cast<double>(std::max<std::size_t>(1, where.stations.size()));
  return track_bound(where, field, hypothesis, mean_energy_loss{}, highland_scattering{}, landau_straggling{layers}, resolution, prior_q_over_pz);
}

}  // namespace scifi
