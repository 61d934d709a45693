// SPDX-License-Identifier: MPL-2.0
// expect: the variance of the projected angle in rad^2, not of the energy
#include <scifi/material/concepts.hpp>

int main() { scifi::require_scattering_policy<scifi::bohr_straggling>(); }
