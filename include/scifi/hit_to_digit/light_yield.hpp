// SPDX-License-Identifier: MPL-2.0
#pragma once

namespace scifi {

/// From energy in a fibre core to photo-electrons: a chain of factors. Defaults: the MICE trackers (Ellis et al., NIM A 659 (2011) 136, and the
/// experiment's configuration); together 174.7 photo-electrons per MeV.
struct light_yield {
  double photons_per_mev = 3047.1;     ///< of the second dye
  double trapping = 0.056;             ///< share that total reflection keeps in each direction of the fibre
  double mirror = 0.6;                 ///< share of the light from the far end that the mirror there returns
  double transmission = 0.8;           ///< of the light guides
  double coupling = 1.0;               ///< of the connectors
  double quantum_efficiency = 0.8;     ///< of the photon counters

  /// Photo-electrons per MeV, on average.
  [[nodiscard]] constexpr double per_mev() const { return photons_per_mev * trapping * (1.0 + mirror) * transmission * coupling * quantum_efficiency; }
  /// Mean number of photo-electrons from an energy deposit (MeV).
  [[nodiscard]] constexpr double photo_electrons(double edep) const { return edep * per_mev(); }
};

}  // namespace scifi
