// SPDX-License-Identifier: MPL-2.0
#include "reconstruct/chains.hpp"

helix_chain make_chain(const scifi::detector& where, const scifi::reconstruction_options& options, const helix_flight& flight_in) {
  return scifi::make_reconstruction(where, options, flight_in);
}
map_chain make_chain(const scifi::detector& where, const scifi::reconstruction_options& options, const map_flight& flight_in) {
  return scifi::make_reconstruction(where, options, flight_in);
}
helix_chain make_chain(const scifi::detector& where, const scifi::reconstruction_options& options) { return scifi::make_reconstruction(where, options); }

void reconstruct(const helix_chain& chain, std::span<scifi::event> events, helix_chain::buffers& work) { chain(events, work); }
void reconstruct(const map_chain& chain, std::span<scifi::event> events, map_chain::buffers& work) { chain(events, work); }
