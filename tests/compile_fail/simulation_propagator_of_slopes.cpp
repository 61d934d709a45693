// SPDX-License-Identifier: MPL-2.0
// expect: scifi: the propagator of a transport needs a const member propagate(moving_particle, dz)
#include <scifi/geometry/mice.hpp>
#include <scifi/particle_to_hit/transport.hpp>
#include <scifi/track_model/helix_propagator.hpp>

int main() {
  [[maybe_unused]] const scifi::transport through(scifi::tracker{}, scifi::transport_settings{}, scifi::coulomb_scattering{}, scifi::collision_loss{}, scifi::helix_propagator{});
}
