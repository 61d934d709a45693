// SPDX-License-Identifier: MPL-2.0
#pragma once

namespace scifi {

/// A doublet layer of scintillating fibres: two rows, staggered by half a pitch, glued into one sheet. All lengths in mm.
/// Defaults: the MICE trackers (Ellis et al., NIM A 659 (2011) 136, and the experiment's geometry files).
struct fibre_doublet {
  double diameter = 0.350;
  double core_diameter = 0.308;
  double pitch = 0.427;              ///< between neighbours of one row
  double row_separation = 0.27734;   ///< in z, between the axes of the two rows: sqrt(diameter^2 - pitch^2/4)
  int fibres_per_channel = 7;        ///< neighbouring fibres, alternating between the rows
  double mylar_thickness = 0.025;

  /// Distance between neighbouring fibres in the measured coordinate.
  [[nodiscard]] constexpr double step() const { return 0.5 * pitch; }
  /// Width of a channel in the measured coordinate.
  [[nodiscard]] constexpr double channel_width() const { return step() * fibres_per_channel; }
  /// Thickness of the doublet in z, without mylar.
  [[nodiscard]] constexpr double thickness() const { return row_separation + diameter; }
  /// Width of the strip that the cores of two neighbouring fibres share: a hit there lights both their channels.
  [[nodiscard]] constexpr double overlap() const { return core_diameter - step(); }
  /// Width that belongs to one channel alone.
  [[nodiscard]] constexpr double unshared() const { return channel_width() - overlap(); }
};

}  // namespace scifi
