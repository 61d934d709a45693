// SPDX-License-Identifier: MPL-2.0
// expect: scifi: flight_in(tracker) must return a tracker_flight
#include <scifi/chain/reconstruction.hpp>

int main() {
  const auto flight_in = [](const scifi::tracker&) { return scifi::helix_propagator{0.9}; };
  [[maybe_unused]] const auto chain = scifi::make_reconstruction(scifi::detector{}, scifi::reconstruction_options{}, flight_in);
}
