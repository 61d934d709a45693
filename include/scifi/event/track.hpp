// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <scifi/event/candidate.hpp>
#include <scifi/kalman/estimate.hpp>
#include <scifi/kalman/status.hpp>

namespace scifi {

/// The fitted track at one plane.
struct track_point {
  int station = 0;
  int plane = 0;
  double z = 0.0;                         ///< tracker frame, mm
  kalman::estimate<double, 5> smoothed;   ///< slope_state (x, tx, y, ty, q/pz); for a line q/pz is given, with variance zero
  int cluster = -1;                       ///< index of the cluster used here, or -1
  bool outlier = false;                   ///< the cluster was there and the gate refused it
  double chi2 = 0.0;                      ///< increment of the filter
  double residual = 0.0;                  ///< measured - fitted with this measurement removed, mm; NaN without one, or if it has no error
  double pull = 0.0;                      ///< residual over its standard deviation; NaN like it
};

/// A fitted track. One that the fit puts outside the active radius at the reference surface is not kept: it never was there.
struct track {
  int tracker = 0;
  int candidate = -1;  ///< index of what it was fitted from
  track_shape shape = track_shape::helix;
  int charge = 0;         ///< sign, from the sense of rotation and the direction of travel; that of the hypothesis for a line
  int stations = 0;       ///< with at least one measurement used
  int planes = 0;         ///< measurements used
  double chi2 = 0.0;
  int ndf = 0;
  double p_value = 0.0;   ///< as the fit's policy has it: in the standard chain of fibres and scattering as they are, not chi-squared's of chi2 and ndf
  kalman::status status;  ///< where and why the fit stopped, if it did
  double z = 0.0;         ///< of the reference surface, tracker frame, mm
  /// x, y (mm), px, py, pz (MeV/c) at the reference surface of the tracker and their 5 x 5 covariance, tracker frame.
  kalman::estimate<double, 5> reference;
  int first_point = 0;  ///< its points in the event's track_points, in order of growing z
  int points = 0;
};

}  // namespace scifi
