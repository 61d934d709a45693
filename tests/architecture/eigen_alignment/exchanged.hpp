// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <scifi/core/linalg.hpp>

/// What the two halves of the program hand to each other: 4 x 4 doubles, whose alignment depends on the compiler flags.
struct exchanged {
  char label;
  scifi::matrix<double, 4, 4> covariance;
};

double trace(const exchanged& from);
