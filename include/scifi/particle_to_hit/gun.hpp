// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>
#include <stdexcept>

#include <scifi/core/constants.hpp>
#include <scifi/core/random.hpp>
#include <scifi/core/refuse.hpp>
#include <scifi/geometry/tracker.hpp>
#include <scifi/particle_to_hit/moving_particle.hpp>

namespace scifi {

/// A beam for tests: one particle at a time, flat in pz, in pt and over a disc, with a uniform azimuth.
struct flat_beam {
  particle hypothesis = muon_plus;
  double pz_min = 100.0;        ///< MeV/c, magnitude
  double pz_max = 280.0;
  double pt_min = 0.0;          ///< MeV/c
  double pt_max = 90.0;
  double pt_over_pz_max = 0.5;  ///< pairs (pt, pz) above it are drawn again
  double radius = 110.0;        ///< of the disc about the z axis, mm
  double distance = 30.0;       ///< of the disc before the first station that the beam meets, mm

  /// Throws std::invalid_argument, naming the culprit, where no particle can be drawn.
  void check() const {
    const auto ordered = [](double low, double high) { return std::isfinite(low) && std::isfinite(high) && low >= 0.0 && low <= high; };
    if (hypothesis.charge == 0) detail::refuse<std::invalid_argument>("flat_beam: the particle must be charged");
    if (!ordered(pz_min, pz_max) || !(pz_max > 0.0)) detail::refuse<std::invalid_argument>("flat_beam: pz needs 0 <= minimum <= maximum, above zero");
    if (!ordered(pt_min, pt_max)) detail::refuse<std::invalid_argument>("flat_beam: pt needs 0 <= minimum <= maximum");
    if (!(pt_min < pt_over_pz_max * pz_max)) detail::refuse<std::invalid_argument>("flat_beam: no pair of pt and pz has a slope below the limit");
    if (!(radius >= 0.0)) detail::refuse<std::invalid_argument>("flat_beam: the radius must not be negative");
  }

  /// A particle that flies along `direction` (+1 or -1) in z, starting on the disc at z (mm). Throws std::invalid_argument where a million pairs of pt and pz, or
  /// all there are, had a slope above the limit.
  [[nodiscard]] moving_particle shoot(double z, int direction, random_stream& random) const {
    double pz = 0.0;
    double pt = 0.0;
    int draws = 0;
    constexpr int most_draws = 1000000;
    do {
      if (++draws > most_draws) detail::refuse<std::invalid_argument>("flat_beam: hardly any pair of pt and pz has a slope below the limit");
      pz = random.uniform(pz_min, pz_max);
      pt = random.uniform(pt_min, pt_max);
    } while (!(pt <= pt_over_pz_max * pz) || !(pz > 0.0));
    const double azimuth = random.uniform(0.0, 2.0 * constants::pi);
    const double r = radius * std::sqrt(random.uniform());
    const double place = random.uniform(0.0, 2.0 * constants::pi);
    moving_particle out;
    out.hypothesis = hypothesis;
    out.position = {r * std::cos(place), r * std::sin(place), z};
    out.momentum = {pt * std::cos(azimuth), pt * std::sin(azimuth), direction * pz};
    return out;
  }

  /// The same at the tracker's upstream end: `distance` before the reference surface of the first station met by its beam.
  [[nodiscard]] moving_particle shoot(const tracker& t, random_stream& random) const {
    if (t.stations.empty()) detail::refuse<std::invalid_argument>("flat_beam: the tracker has no station");
    const station& first = t.beam_direction > 0 ? t.stations.front() : t.stations.back();
    return shoot(first.in_tracker.origin.z() - t.beam_direction * distance, t.beam_direction, random);
  }
};

}  // namespace scifi
