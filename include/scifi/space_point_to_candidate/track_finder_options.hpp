// SPDX-License-Identifier: MPL-2.0
#pragma once

namespace scifi {

/// What pattern recognition may assume and where it cuts.
struct track_finder_options {
  double field = 0.0;              ///< Bz in the tracker frame, (MeV/c)/(e mm); zero: straight tracks
  double line_momentum = 200.0;    ///< MeV/c, assumed for straight tracks
  int line_charge = 1;             ///< sign, assumed for straight tracks
  int min_stations = 4;            ///< of a candidate
  double largest_slope = 0.6;      ///< pt/pz
  double smallest_pz = 50.0;       ///< MeV/c
  double gate = 30.0;              ///< largest squared distance of a point from its prediction, two degrees of freedom (p = 3e-7)
  double chi2_per_ndf = 12.0;      ///< largest of a candidate
  double cluster_gain = 10.0;      ///< chi2 that one cluster more is worth when candidates compete
  double typical_q_over_pz = 0.006;  ///< 1/(MeV/c): centre, with either sign, of the prior of q/pz ...
  double spread_q_over_pz = 0.004;   ///< ... and its width; matters only where the field hardly bends the track
  int max_arc_fits = 100000;       ///< bound on the search in one tracker
};

}  // namespace scifi
