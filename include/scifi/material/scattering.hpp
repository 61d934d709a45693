// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstddef>

#include <scifi/core/scalar.hpp>
#include <scifi/material/highland.hpp>
#include <scifi/material/particle.hpp>
#include <scifi/material/slab.hpp>

namespace scifi {

/// The quantity whose variance a scattering policy gives: the angle projected on a plane, rad.
struct scattering_angle {};

/// No multiple scattering, said in so many words.
struct no_scattering {
  using variance_of = scattering_angle;

  template <scalar Scalar>
  [[nodiscard]] Scalar variance(const Scalar&, const particle&, const slab&, const Scalar&) const {
    return Scalar(0.0);
  }
};

/// Multiple scattering after Highland, see `highland_variance`.
struct highland_scattering {
  using variance_of = scattering_angle;

  /// Variance of the projected angle (rad^2) in the slab; p in MeV/c, path_over_thickness = 1/cos(angle to z) >= 1.
  template <scalar Scalar>
  [[nodiscard]] Scalar variance(const Scalar& p, const particle& hypothesis, const slab& s, const Scalar& path_over_thickness) const {
    const Scalar own = path_over_thickness * Scalar(radiation_lengths(s));
    const Scalar layer = path_over_thickness * Scalar(s.layer_radiation_lengths);
    return highland_variance(p, hypothesis, own, layer);
  }
  template <scalar Scalar>
  [[nodiscard]] Scalar variance(const crossing_particle<Scalar>& crossing, const particle& hypothesis, const slab& s) const {
    return highland_variance(crossing, hypothesis, radiation_lengths(s), s.layer_radiation_lengths);
  }
  template <std::size_t Capacity>
  [[nodiscard]] prepared_highland prepared(const particle& hypothesis, const slab_stack<Capacity>& stack) const {
    prepared_highland out;
    for (const slab& s : stack) out.add(hypothesis, radiation_lengths(s), s.layer_radiation_lengths);
    return out;
  }
};

}  // namespace scifi
