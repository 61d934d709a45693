// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <span>
#include <utility>

#include <scifi/chain/reconstruction.hpp>
#include <scifi/event/event.hpp>

#include "field/chosen_flight.hpp"

/// The standard chain with this flight.
template <class FlightIn>
using chain_with =
    decltype(scifi::make_reconstruction(std::declval<const scifi::detector&>(), std::declval<const scifi::reconstruction_options&>(), std::declval<const FlightIn&>()));
using helix_chain = chain_with<helix_flight>;
using map_chain = chain_with<map_flight>;

/// Reconstructs a block of events. Compiled once, in chains.cpp, for all programs: it is what takes longest.
void reconstruct(const helix_chain& chain, std::span<scifi::event> events, helix_chain::buffers& work);
void reconstruct(const map_chain& chain, std::span<scifi::event> events, map_chain::buffers& work);
