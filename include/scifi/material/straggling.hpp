// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cstddef>

#include <scifi/core/inline_vector.hpp>
#include <scifi/core/scalar.hpp>
#include <scifi/material/kinematics.hpp>
#include <scifi/material/landau.hpp>
#include <scifi/material/particle.hpp>
#include <scifi/material/slab.hpp>

namespace scifi {

/// The quantity whose variance a straggling policy gives: the energy lost, MeV.
struct lost_energy {};

/// No energy straggling, said in so many words.
struct no_straggling {
  using variance_of = lost_energy;

  template <scalar Scalar>
  [[nodiscard]] Scalar variance(const Scalar&, const particle&, const slab&, const Scalar&) const {
    return Scalar(0.0);
  }
};

/// Variance (MeV^2) of the whole distribution about the mean loss, tail included, see `bohr_variance`. Goes with `mean_energy_loss`.
struct bohr_straggling {
  using variance_of = lost_energy;

  /// p in MeV/c; path_over_thickness = 1/cos(angle to z) >= 1.
  template <scalar Scalar>
  [[nodiscard]] Scalar variance(const Scalar& p, const particle& hypothesis, const slab& s, const Scalar& path_over_thickness) const {
    const ionisation_kinematics<Scalar> k = ionisation_kinematics_of(p, hypothesis);
    const Scalar xi = landau_xi(k, hypothesis, s.medium, Scalar(path_over_thickness * Scalar(s.thickness)));
    return bohr_variance(xi, k);
  }
};

/// The variance that a stack of slabs adds with `landau_straggling`, prepared for any momentum.
///
/// While the core is the smaller in each slab, which is so in thin ones, their sum is that of xi^2 core times (path/beta^2)^2.
template <std::size_t Capacity>
class prepared_landau_straggling {
 public:
  /// A slab of xi (MeV, for beta = 1 along the normal) whose share of the core's variance is `core` xi^2.
  void add(double xi, double core) {
    slabs_.push_back({xi, core});
    core_ += xi * xi * core;
    thickest_ = std::max(thickest_, xi * core);
  }

  /// Of the energy, MeV^2.
  template <scalar Scalar>
  [[nodiscard, gnu::always_inline]] Scalar variance(const crossing_particle<Scalar>& c) const {
    const Scalar whole = bohr_variance(Scalar(1.0), c.kinematics);
    if (all_of(c.path_over_beta_squared * Scalar(thickest_) <= whole)) return c.path_over_beta_squared * c.path_over_beta_squared * Scalar(core_);
    return slab_by_slab(c.path_over_beta_squared, whole);
  }

 private:
  template <scalar Scalar>
  [[nodiscard, gnu::noinline]] Scalar slab_by_slab(Scalar path_over_beta_squared, Scalar whole) const {
    Scalar sum(0.0);
    for (const part& s : slabs_) {
      const Scalar xi = path_over_beta_squared * Scalar(s.xi);
      sum += xi * smaller_of(Scalar(xi * Scalar(s.core)), whole);
    }
    return sum;
  }
  struct part {
    double xi, core;
  };
  inline_vector<part, Capacity> slabs_;
  double core_ = 0.0;
  double thickest_ = 0.0;
};

/// Variance (MeV^2) of the Gaussian as wide at half maximum as the Landau core, (4.018 xi / 2.355)^2. Goes with the most probable or the
/// median loss.
///
/// Landau widths add linearly and variances must add, so the core's variance is shared: a slab gets (4.018/2.355)^2 xi xi_total with
/// xi_total that of `traversed_layers` layers, and the sum over them is the core of the total. Never above `bohr_straggling` of
/// the slab, the variance of the whole distribution (reached when kappa of the total is about 0.2 to 0.3).
struct landau_straggling {
  using variance_of = lost_energy;

  double traversed_layers = 1.0;

  template <scalar Scalar>
  [[nodiscard]] Scalar variance(const Scalar& p, const particle& hypothesis, const slab& s, const Scalar& path_over_thickness) const {
    const ionisation_kinematics<Scalar> k = ionisation_kinematics_of(p, hypothesis);
    const Scalar xi = landau_xi(k, hypothesis, s.medium, Scalar(path_over_thickness * Scalar(s.thickness)));
    const Scalar xi_total = landau_xi(k, hypothesis, s.medium, Scalar(path_over_thickness * Scalar(layer_thickness(s) * traversed_layers)));
    const Scalar core = xi * xi_total * Scalar(landau::core_width * landau::core_width);
    return smaller_of(core, bohr_variance(xi, k));
  }
  template <scalar Scalar>
  [[nodiscard]] Scalar variance(const crossing_particle<Scalar>& crossing, const particle& hypothesis, const slab& s) const {
    return prepared(hypothesis, slab_stack<1>{}.add(s)).variance(crossing);
  }
  template <std::size_t Capacity>
  [[nodiscard]] prepared_landau_straggling<Capacity> prepared(const particle& hypothesis, const slab_stack<Capacity>& stack) const {
    prepared_landau_straggling<Capacity> out;
    for (const slab& s : stack) {
      const double core = landau::core_width * landau::core_width * traversed_layers;
      if (s.thickness > 0.0) out.add(landau_xi_per_mm(hypothesis, s.medium) * s.thickness, core * layer_thickness(s) / s.thickness);
    }
    return out;
  }
};

}  // namespace scifi
