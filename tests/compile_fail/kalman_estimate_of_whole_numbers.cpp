// SPDX-License-Identifier: MPL-2.0
// expect: scifi: an estimate cannot be of whole numbers
#include <scifi/kalman/estimate.hpp>

int main() { return scifi::kalman::uncorrelated(scifi::vector<int, 2>(0, 0), scifi::vector<int, 2>(100, 10)).mean[0]; }
