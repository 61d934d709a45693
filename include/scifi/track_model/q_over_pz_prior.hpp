// SPDX-License-Identifier: MPL-2.0
#pragma once

namespace scifi {

/// What is known of |q/pz| before a track is seen, in e/(MeV/c): a Gaussian about `typical`, for either sign. Pattern recognition and fit share it.
///
/// Broad on purpose: it covers pz from 100 to 500 MeV/c with one standard deviation and weighs less than 2 % where pz = 200 MeV/c is known to 20 MeV/c or better.
/// It matters only where the field hardly bends the track; there it keeps pz finite and its error honest.
struct q_over_pz_prior {
  double typical = 0.006;
  double spread = 0.004;
};

}  // namespace scifi
