// SPDX-License-Identifier: MPL-2.0
// expect: scifi: the energy loss of a transport needs a const member sample(p, particle, medium, path, random)
#include <scifi/geometry/mice.hpp>
#include <scifi/particle_to_hit/transport.hpp>

int main() { [[maybe_unused]] const scifi::transport through(scifi::tracker{}, scifi::transport_settings{}, scifi::coulomb_scattering{}, scifi::mean_energy_loss{}); }
