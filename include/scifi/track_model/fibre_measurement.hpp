// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>

#include <scifi/core/linalg.hpp>

namespace scifi {

/// One measured coordinate alpha of a plane at constant z: alpha = cos x + sin y - offset. For any state space with components x and y.
///
/// `projection()` is the row H; the offset of the plane (mm) is added to the measured value so that the model is linear without a constant.
template <class StateSpace, class Scalar = double>
struct fibre_measurement {
  using state_space = StateSpace;
  static constexpr std::array seen_components{StateSpace::x, StateSpace::y};
  Scalar alpha{0.0};           ///< measured, plane frame, mm
  Scalar alpha_variance{1.0};  ///< mm^2
  double cos_angle = 1.0;
  double sin_angle = 0.0;
  double offset = 0.0;  ///< mm

  [[nodiscard]] Scalar value() const { return alpha + Scalar(offset); }
  [[nodiscard]] Scalar covariance() const { return alpha_variance; }
  [[nodiscard]] matrix<double, 1, StateSpace::dimension> projection() const {
    matrix<double, 1, StateSpace::dimension> h = matrix<double, 1, StateSpace::dimension>::Zero();
    h(0, StateSpace::x) = cos_angle;
    h(0, StateSpace::y) = sin_angle;
    return h;
  }
};

/// A measured point (x, y) at constant z, tracker frame, mm. For any state space with components x and y.
template <class StateSpace>
struct point_measurement {
  using state_space = StateSpace;
  static constexpr std::array seen_components{StateSpace::x, StateSpace::y};
  vector<double, 2> position = vector<double, 2>::Zero();
  matrix<double, 2, 2> position_covariance = matrix<double, 2, 2>::Identity();

  [[nodiscard]] vector<double, 2> value() const { return position; }
  [[nodiscard]] matrix<double, 2, 2> covariance() const { return position_covariance; }
  [[nodiscard]] matrix<double, 2, StateSpace::dimension> projection() const {
    matrix<double, 2, StateSpace::dimension> h = matrix<double, 2, StateSpace::dimension>::Zero();
    h(0, StateSpace::x) = 1.0;
    h(1, StateSpace::y) = 1.0;
    return h;
  }
};

}  // namespace scifi
