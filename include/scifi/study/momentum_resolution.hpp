// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>
#include <cstddef>

#include <scifi/event/track.hpp>
#include <scifi/information/track_bound.hpp>
#include <scifi/study/contents.hpp>
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

/// One component of the momentum for many tracks: residuals, the standard deviations that the fit states, and the least that are possible.
struct momentum_samples {
  sample residual, stated, bound;

  momentum_samples& operator+=(const momentum_samples& other) {
    each(merge, other);
    return *this;
  }
  /// Calls visit(part), or visit(part, the same one of `other`), for everything that is merged.
  template <class Visit, class... Others>
  void each(const Visit& visit, const Others&... other) {
    visit(residual, other.residual...);
    visit(stated, other.stated...);
    visit(bound, other.bound...);
  }
};

/// The tracks of one cell.
struct momentum_cell {
  momentum_samples pt, pz;

  void operator()(const momentum_pair& residual, const momentum_pair& stated, const momentum_pair& bound) {
    const auto add = [](momentum_samples& to, double off, double sigma, double least) {
      to.residual.add(off);
      to.stated.add(sigma);
      to.bound.add(least);
    };
    add(pt, residual.pt, stated.pt, bound.pt);
    add(pz, residual.pz, stated.pz, bound.pz);
  }
  momentum_cell& operator+=(const momentum_cell& other) {
    each(merge, other);
    return *this;
  }
  /// Calls visit(part), or visit(part, the same one of `other`), for everything that is merged.
  template <class Visit, class... Others>
  void each(const Visit& visit, const Others&... other) {
    visit(pt, other.pt...);
    visit(pz, other.pz...);
  }
};

/// When the median of a cell's residuals counts as a shift of the momentum: beyond this share of its spread, with more than so many tracks.
struct shift_rule {
  double share_of_spread = 0.03;
  std::size_t more_tracks_than = 200;

  [[nodiscard]] bool operator()(const summary& residuals) const {
    return residuals.count > more_tracks_than && std::abs(residuals.median) > share_of_spread * residuals.spread;
  }
  /// Probability that a cell with so many tracks counts as shifted although its residuals have no shift, for the statistical error of the median alone.
  [[nodiscard]] double by_chance(const summary& residuals) const {
    if (residuals.count <= more_tracks_than) return 0.0;
    return std::erfc(share_of_spread * residuals.spread / (residuals.median_error * std::sqrt(2.0)));
  }
};

/// Resolution and bias of the momentum against true pt and |pz| at the reference surface, in fine cells to be looked at in each of the two, and in wide ones
/// for both together. Merged with +=.
class momentum_resolution {
 public:
  explicit momentum_resolution(const momentum_edges& fine = {}, const momentum_edges& wide = wide_momentum_edges())
      : fine_(make_momentum_grid<momentum_cell>(fine)), wide_(make_momentum_grid<momentum_cell>(wide)) {}

  /// A line has no momentum and is passed over.
  void add(const true_track& particle, const track& t, const reference_bound& limit) {
    if (t.shape == track_shape::line) return;
    using m = momentum_state;
    const auto off = residuals_of(particle, t);
    const vector<double, 5> truth = particle.state();
    const double pt = particle.pt();
    const vector<double, 2> along = pt > 0.0 ? vector<double, 2>(truth[m::px] / pt, truth[m::py] / pt) : vector<double, 2>(1.0, 0.0);
    const matrix<double, 2, 2> transverse = t.reference.covariance.block<2, 2>(m::px, m::px);
    const momentum_pair residual{off[residual_quantity::pt], off[residual_quantity::pz]};
    const momentum_pair stated{std::sqrt(along.dot(transverse * along)), kalman::sigma(t.reference, m::pz)};
    const momentum_pair bound{limit.pt, kalman::sigma(limit.momentum, m::pz)};
    for (auto* cells : {&fine_, &wide_}) (*cells)(pt, std::abs(truth[m::pz]), boost::histogram::sample(residual, stated, bound));
  }
  momentum_resolution& operator+=(const momentum_resolution& other) {
    each(merge, other);
    return *this;
  }
  /// Calls visit(part), or visit(part, the same one of `other`), for everything that is merged.
  template <class Visit, class... Others>
  void each(const Visit& visit, const Others&... other) {
    visit(fine_, other.fine_...);
    visit(wide_, other.wide_...);
  }

  [[nodiscard]] const momentum_grid<momentum_cell>& fine() const { return fine_; }
  [[nodiscard]] const momentum_grid<momentum_cell>& wide() const { return wide_; }

 private:
  momentum_grid<momentum_cell> fine_, wide_;
};

}  // namespace scifi::study
