// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

#include <scifi/event/track.hpp>
#include <scifi/information/track_bound.hpp>
#include <scifi/study/contents.hpp>
#include <scifi/study/distribution.hpp>
#include <scifi/study/efficiency.hpp>
#include <scifi/study/sample.hpp>
#include <scifi/study/true_track.hpp>
#include <scifi/track_model/helix_state.hpp>
#include <scifi/track_model/slope_state.hpp>

namespace scifi::study {

/// What is compared at the reference surface, reconstructed - true: x, y; the slopes dx/dz, dy/dz; pt along its true direction; |pz|.
struct residual_quantity {
  enum component { x, y, tx, ty, pt, pz };
  static constexpr std::size_t dimension = 6;
  static constexpr std::array<std::string_view, dimension> names{"x", "y", "tx", "ty", "pt", "pz"};
  static constexpr std::array<std::string_view, dimension> units{"mm", "mm", "1", "1", "MeV/c", "MeV/c"};
  static constexpr std::array<double, dimension> reaches{2.5, 2.5, 0.05, 0.05, 8.0, 40.0};  ///< of the histograms, either side of zero
};

/// The residuals of one track. The component of the momentum along the true direction of pt is not biased where pt is as small as its error.
[[nodiscard]] inline std::array<double, residual_quantity::dimension> residuals_of(const true_track& particle, const track& t) {
  using m = momentum_state;
  const vector<double, 5> truth = particle.state();
  const vector<double, 5>& fit = t.reference.mean;
  constexpr double no_direction = 1e-9;  // MeV/c: a particle along the axis
  const double along = (fit[m::px] * truth[m::px] + fit[m::py] * truth[m::py]) / std::max(particle.pt(), no_direction);
  return {fit[m::x] - truth[m::x],
          fit[m::y] - truth[m::y],
          fit[m::px] / fit[m::pz] - truth[m::px] / truth[m::pz],
          fit[m::py] / fit[m::pz] - truth[m::py] / truth[m::pz],
          along - particle.pt(),
          std::abs(fit[m::pz]) - std::abs(truth[m::pz])};
}

/// The standard deviations that no unbiased fit of this track can go below, in the same order.
[[nodiscard]] inline std::array<double, residual_quantity::dimension> bounds_of(const reference_bound& b) {
  using m = momentum_state;
  using s = slope_state;
  return {kalman::sigma(b.momentum, m::x), kalman::sigma(b.momentum, m::y), kalman::sigma(b.slopes, s::tx), kalman::sigma(b.slopes, s::ty), b.pt, kalman::sigma(b.momentum, m::pz)};
}

/// Residuals and pulls (residual over stated standard deviation) at the reference surface. Merged with +=.
class state_residuals {
 public:
  state_residuals()
      : residual_(make(std::make_index_sequence<residual_quantity::dimension>(), [](std::size_t i) {
          return distribution(100, -residual_quantity::reaches[i], residual_quantity::reaches[i],
                              std::string(residual_quantity::names[i]) + " [" + std::string(residual_quantity::units[i]) + "]");
        })),
        pull_(make(std::make_index_sequence<momentum_state::dimension>(),
                   [](std::size_t i) { return distribution(100, -5.0, 5.0, "pull of " + std::string(momentum_state::names[i])); })) {}

  /// A component without a standard deviation (the momentum of a line along z) has no pull. The momentum of a line is an assumption: it has
  /// neither residuals nor pulls.
  void add(const true_track& particle, const track& t, const reference_bound& limit) {
    using q = residual_quantity;
    const auto off = residuals_of(particle, t);
    const auto least = bounds_of(limit);
    const bool line = t.shape == track_shape::line;
    for (std::size_t i = 0; i < q::dimension; ++i) {
      if (line && (i == q::pt || i == q::pz)) continue;
      residual_[i].add(off[i]);
      bound_[i].add(least[i]);
    }
    const vector<double, 5> truth = particle.state();
    for (std::size_t i = 0; i < pull_.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      const double sigma = kalman::sigma(t.reference, k);
      if (sigma > 0.0 && (!line || k < momentum_state::px)) pull_[i].add((t.reference.mean[k] - truth[k]) / sigma);
    }
    if (!line) charge_(t.charge == particle.charge);
  }
  state_residuals& operator+=(const state_residuals& other) {
    each(merge, other);
    return *this;
  }
  /// Calls visit(part), or visit(part, the same one of `other`), for everything that is merged.
  template <class Visit, class... Others>
  void each(const Visit& visit, const Others&... other) {
    for (std::size_t i = 0; i < residual_.size(); ++i) visit(residual_[i], other.residual_[i]...);
    for (std::size_t i = 0; i < bound_.size(); ++i) visit(bound_[i], other.bound_[i]...);
    for (std::size_t i = 0; i < pull_.size(); ++i) visit(pull_[i], other.pull_[i]...);
    visit(charge_, other.charge_...);
  }

  [[nodiscard]] const distribution& residual(residual_quantity::component c) const { return residual_[c]; }
  [[nodiscard]] const distribution& pull(momentum_state::component c) const { return pull_[c]; }
  /// The bound of each track with a residual; `mixture_spread` of them is what the spread of the residuals would be at the bound.
  [[nodiscard]] const sample& bound(residual_quantity::component c) const { return bound_[c]; }
  /// Tracks with the right sign of charge, of all that are bent.
  [[nodiscard]] const found_share& charge() const { return charge_; }

 private:
  template <std::size_t... Is, class Make>
  [[nodiscard]] static std::array<distribution, sizeof...(Is)> make(std::index_sequence<Is...>, const Make& one) {
    return {one(Is)...};
  }

  std::array<distribution, residual_quantity::dimension> residual_;
  std::array<distribution, momentum_state::dimension> pull_;
  std::array<sample, residual_quantity::dimension> bound_;
  found_share charge_;
};

}  // namespace scifi::study
