// SPDX-License-Identifier: MPL-2.0
#include "reconstruct/chains.hpp"

void reconstruct(const helix_chain& chain, std::span<scifi::event> events, helix_chain::buffers& work) { chain(events, work); }
void reconstruct(const map_chain& chain, std::span<scifi::event> events, map_chain::buffers& work) { chain(events, work); }
