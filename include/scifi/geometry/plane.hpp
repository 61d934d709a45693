// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>
#include <string>

#include <scifi/geometry/placement.hpp>
#include <scifi/material/slab.hpp>

namespace scifi {

/// A detector plane that measures one coordinate, alpha, in equal channels: a fibre doublet layer, a silicon strip sensor, ...
///
/// In the plane frame alpha is measured, beta runs along the fibres or strips. The plane frame is the station frame turned by `angle`:
///   alpha = x cos(angle) + y sin(angle),  beta = -x sin(angle) + y cos(angle).
/// alpha falls as the channel number grows: alpha = (central_channel - channel) * channel_width.
struct plane {
  std::string view;              ///< name of the view: "V", "W", "U"
  double angle = 0.0;            ///< direction of alpha in the station frame, rad
  int channels = 0;              ///< channels are numbered 0 .. channels - 1
  double central_channel = 0.0;  ///< the (possibly half-integer) channel at alpha = 0
  double channel_width = 1.0;    ///< mm
  double z_reference = 0.0;      ///< outer surface on the side of smaller z, station frame, mm: where truth is given
  double z_measured = 0.0;       ///< where alpha is measured: the middle of the sensitive layer, station frame, mm
  slab_stack<4> below;           ///< material from z_reference to z_measured, in order of growing z
  slab_stack<4> above;           ///< material from z_measured to the far surface, in order of growing z

  /// Coordinate of a (possibly fractional) channel number, plane frame, mm.
  [[nodiscard]] double alpha(double channel) const { return (central_channel - channel) * channel_width; }
  /// Channel number, not rounded, at a coordinate alpha (plane frame, mm). May lie outside 0 .. channels - 1.
  [[nodiscard]] double channel_at(double alpha_mm) const { return central_channel - alpha_mm / channel_width; }
  /// True for a channel number that exists.
  [[nodiscard]] bool has_channel(int channel) const { return channel >= 0 && channel < channels; }
  /// Where the plane frame sits in the station frame.
  [[nodiscard]] placement in_station() const { return {{0.0, 0.0, z_measured}, angle}; }
};

}  // namespace scifi
