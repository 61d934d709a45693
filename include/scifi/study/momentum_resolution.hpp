// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>
#include <cstddef>

#include <scifi/event/track.hpp>
#include <scifi/study/momentum_bins.hpp>
#include <scifi/study/sample.hpp>
#include <scifi/study/state_residuals.hpp>
#include <scifi/study/true_track.hpp>
#include <scifi/track_model/helix_state.hpp>

namespace scifi::study {

/// One number for pt and one for pz, MeV/c.
struct momentum_pair {
  double pt = 0.0;
  double pz = 0.0;
};

/// Residuals of pt and pz of the tracks of one cell, and the standard deviations that the fit states.
struct momentum_cell {
  sample pt, pz, stated_pt, stated_pz;

  void operator()(const momentum_pair& residual, const momentum_pair& stated) {
    pt.add(residual.pt);
    pz.add(residual.pz);
    stated_pt.add(stated.pt);
    stated_pz.add(stated.pz);
  }
  momentum_cell& operator+=(const momentum_cell& other) {
    pt += other.pt;
    pz += other.pz;
    stated_pt += other.stated_pt;
    stated_pz += other.stated_pz;
    return *this;
  }
};

/// When the median of a cell's residuals counts as a shift of the momentum: beyond this share of its spread, with more than so many tracks.
struct shift_rule {
  double share_of_spread = 0.03;
  std::size_t more_tracks_than = 200;

  [[nodiscard]] bool operator()(const summary& residuals) const {
    return residuals.count > more_tracks_than && std::abs(residuals.median) > share_of_spread * residuals.spread;
  }
};

/// Resolution and bias of the momentum against true pt and |pz| at the reference surface. Merged with +=.
class momentum_resolution {
 public:
  explicit momentum_resolution(const momentum_edges& edges = {}) : grid_(make_momentum_grid<momentum_cell>(edges)) {}

  /// A line has no momentum and is passed over.
  void add(const true_track& particle, const track& t) {
    if (t.shape == track_shape::line) return;
    using m = momentum_state;
    const auto off = residuals_of(particle, t);
    const vector<double, 5> truth = particle.state();
    const double pt = particle.pt();
    const vector<double, 2> along = pt > 0.0 ? vector<double, 2>(truth[m::px] / pt, truth[m::py] / pt) : vector<double, 2>(1.0, 0.0);
    const matrix<double, 2, 2> transverse = t.reference.covariance.block<2, 2>(m::px, m::px);
    const momentum_pair residual{off[residual_quantity::pt], off[residual_quantity::pz]};
    const momentum_pair stated{std::sqrt(along.dot(transverse * along)), kalman::sigma(t.reference, m::pz)};
    grid_(pt, std::abs(truth[m::pz]), boost::histogram::sample(residual, stated));
  }
  momentum_resolution& operator+=(const momentum_resolution& other) {
    grid_ += other.grid_;
    return *this;
  }

  [[nodiscard]] const momentum_grid<momentum_cell>& grid() const { return grid_; }

 private:
  momentum_grid<momentum_cell> grid_;
};

}  // namespace scifi::study
