// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>

namespace reference::nile {

/// Annual flow of the Nile at Aswan, 1871 to 1970, 1e8 m^3 (Cobb, Biometrika 65 (1978) 243; data set `Nile` of R). Its mean is 919.35.
inline constexpr std::array<double, 100> flow{
    1120, 1160, 963, 1210, 1160, 1160, 813, 1230, 1370, 1140, 995, 935, 1110, 994, 1020, 960, 1180, 799, 958, 1140, 1100, 1210, 1150, 1250, 1260,
    1220, 1030, 1100, 774,  840,  874,  694, 940,  833,  701,  916, 692, 1020, 1050, 969, 831,  726, 456, 824,  702,  1120, 1100, 832,  764,  821,
    768,  845,  864, 862,  698,  845,  744, 796,  1040, 759,  781, 865, 845,  944, 984,  897,  822, 1010, 771, 676,  649,  846,  812,  742,  801,
    1040, 860,  874, 848,  890,  744,  749, 838,  1050, 918,  986, 797, 923,  975, 815,  1020, 906, 901, 1170, 912,  746,  919,  718,  714,  740};

/// Variances of the measurement and of a year's change of the level: Durbin and Koopman, Time Series Analysis by State Space Methods, 2nd ed. (2012), 2.10.3.
inline constexpr double measured = 15099.0, change = 1469.1;

/// Logarithms of the likelihood at these variances, as R's package KFAS gives them: with a level of 0 and variance 1e7 in the first year, as in section
/// 2.2.5, and with nothing known of the first year, which is then not counted. R's package statespacer, which counts its constant, publishes -633.4646.
inline constexpr double vague_start = -641.5856, unknown_start = -632.5456;

}  // namespace reference::nile
