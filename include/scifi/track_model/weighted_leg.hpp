// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <functional>

#include <scifi/core/linalg.hpp>
#include <scifi/kalman/process_noise.hpp>
#include <scifi/kalman/propagation.hpp>
#include <scifi/material/straggling.hpp>
#include <scifi/track_model/leg.hpp>
#include <scifi/track_model/material_noise.hpp>

namespace scifi {

/// A leg whose thin material at either end scatters with so many times the usual variance: 1 changes nothing.
struct weighted_leg {
  std::reference_wrapper<const leg> way;
  double start = 1.0;
  double finish = 1.0;
};

/// A propagator of legs that takes weighted ones: weights do not move the mean.
template <class Propagator>
struct weighted_propagator {
  using state_space = typename Propagator::state_space;
  Propagator inner;
  template <class Scalar, int N>
  [[nodiscard]] kalman::propagated<Scalar, N> propagate(const vector<Scalar, N>& start, const weighted_leg& step) const {
    return kalman::propagate(inner, start, step.way.get());
  }
};

/// The scattering of a material noise alone, energy straggling left out.
template <class Scattering, class Straggling>
[[nodiscard]] auto scattering_of(const material_noise<Scattering, Straggling>& all) {
  return material_noise<Scattering, no_straggling>{all.scattering, {}, all.hypothesis};
}
template <class Scattering>
[[nodiscard]] line_material_noise<Scattering> scattering_of(const line_material_noise<Scattering>& all) {
  return all;
}

/// A material noise for weighted legs: scattering of the weighted stacks is multiplied, straggling is not. Law: with weights of 1 it is the inner noise.
template <class Noise>
struct weighted_noise {
  using state_space = typename Noise::state_space;
  Noise inner;
  template <class Scalar, int N>
  [[nodiscard]] matrix<Scalar, N, N> covariance(const vector<Scalar, N>& start, const weighted_leg& step, const kalman::propagated<Scalar, N>& moved) const {
    const leg& way = step.way;
    matrix<Scalar, N, N> q = kalman::detail::noise_covariance<Scalar, N>(inner, start, way, moved);
    const auto add = [&](double weight, bool at_start) {
      if (weight == 1.0 || (at_start ? way.start : way.finish).empty()) return;
      leg alone = way;
      alone.gap = {};
      (at_start ? alone.finish : alone.start) = {};
      q += Scalar(weight - 1.0) * kalman::detail::noise_covariance<Scalar, N>(scattering_of(inner), start, alone, moved);
    };
    add(step.start, true);
    add(step.finish, false);
    return q;
  }
};

template <class Propagator>
weighted_propagator(Propagator) -> weighted_propagator<Propagator>;
template <class Noise>
weighted_noise(Noise) -> weighted_noise<Noise>;

}  // namespace scifi
