// SPDX-License-Identifier: MPL-2.0
// What the compile costs are compared with: Eigen alone.
#include <Eigen/Dense>
