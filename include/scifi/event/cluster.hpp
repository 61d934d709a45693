// SPDX-License-Identifier: MPL-2.0
#pragma once

namespace scifi {

/// Neighbouring digits of one plane, taken as one crossing.
struct cluster {
  int tracker = 0;
  int station = 1;
  int plane = 0;
  double channel = 0.0;   ///< unweighted mean of the channel numbers
  double npe = 0.0;       ///< sum of the light, photo-electrons
  double alpha = 0.0;     ///< measured coordinate, plane frame, mm
  double variance = 0.0;  ///< of alpha, mm^2
  int first_digit = 0;    ///< index of the first of its digits in the event's sorted digits
  int size = 0;           ///< number of digits; they follow each other
};

}  // namespace scifi
