// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <span>

#include <scifi/chain/reconstruction.hpp>
#include <scifi/event/event.hpp>

#include "field/chosen_flight.hpp"

/// The standard chain in a uniform field, and in a map.
using helix_chain = scifi::standard_reconstruction<scifi::helix_propagator>;
using map_chain = scifi::standard_reconstruction<scifi::nystrom_propagator<scifi::field_map>>;

// All that makes and runs chains is compiled once, in chains.cpp, for all programs: it is what takes longest.

/// The chain in the field that was chosen. Throws std::invalid_argument.
[[nodiscard]] helix_chain make_chain(const scifi::detector& where, const scifi::reconstruction_options& options, const helix_flight& flight_in);
[[nodiscard]] map_chain make_chain(const scifi::detector& where, const scifi::reconstruction_options& options, const map_flight& flight_in);
/// The chain in the uniform field that the options say.
[[nodiscard]] helix_chain make_chain(const scifi::detector& where, const scifi::reconstruction_options& options);

/// Reconstructs a block of events.
void reconstruct(const helix_chain& chain, std::span<scifi::event> events, helix_chain::buffers& work);
void reconstruct(const map_chain& chain, std::span<scifi::event> events, map_chain::buffers& work);
