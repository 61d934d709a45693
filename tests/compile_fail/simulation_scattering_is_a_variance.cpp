// SPDX-License-Identifier: MPL-2.0
// expect: scifi: the scattering of a transport needs a const member sample(p, particle, slab, path_over_thickness, random)
#include <scifi/geometry/mice.hpp>
#include <scifi/particle_to_hit/transport.hpp>

int main() { [[maybe_unused]] const scifi::transport through(scifi::tracker{}, scifi::transport_settings{}, scifi::highland_scattering{}, scifi::collision_loss{}); }
