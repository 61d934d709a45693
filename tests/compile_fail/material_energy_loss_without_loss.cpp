// SPDX-License-Identifier: MPL-2.0
// expect: the energy-loss policy needs a const member loss
#include <scifi/material/concepts.hpp>

struct my_energy_loss {
  double value(double p) const { return p; }
};

int main() { scifi::require_energy_loss_policy<my_energy_loss>(); }
