// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>
#include <concepts>

#include <scifi/core/constants.hpp>
#include <scifi/geometry/fibre.hpp>
#include <scifi/geometry/plane.hpp>

namespace scifi {

/// What a resolution policy is told about a cluster.
struct cluster_light {
  int size = 1;           ///< channels
  double least = 0.0;     ///< smallest light of one of its channels, photo-electrons
  double total = 0.0;     ///< photo-electrons
};

/// A policy that gives the variance (mm^2, positive) of alpha for a cluster of a plane.
/// Law: the residual measured - true of such clusters has this variance.
template <class R>
concept cluster_resolution = requires(const R r, const plane& p, const cluster_light& light) {
  { r.variance(p, light) } -> std::convertible_to<double>;
};

/// d^2/12 of the channel width for every cluster: the figure of the literature (Ellis et al., NIM A 659 (2011) 136), right for any strip detector
/// that says no more than which strip was hit.
struct uniform_resolution {
  [[nodiscard]] double variance(const plane& p, const cluster_light&) const { return p.channel_width * p.channel_width / 12.0; }
};

/// By the size of the cluster, for doublets of fibres: one channel was hit where no neighbour shares it, two in the overlap of their edge fibres.
///
/// One channel: d^2/12 of the channel width; the strip no neighbour shares is a little narrower, but positions made of two or three uniform errors have
/// a central 68 % that is 3..7 % wider than their standard deviation, and the full width makes the stated errors cover it. Two: uniform over the overlap, widened by the distance of the two rows times a typical
/// slope. A weak second channel may be noise beside a crossing of the first: with the share of noise among such pairs,
///   share(n) = noise(n) / (noise(n) + true(n)),  noise(n) = 2 rate phi(n - 1),  true(n) = (overlap / width) / typical_light,
/// phi the unit normal density of the read-out's response, n the smaller light; a floor holds the delta rays and, above, pairs brighter
/// than one particle makes. A wrong pair misses by half a channel. Longer runs: uniform over their length.
struct fibre_resolution {
  fibre_doublet fibre{};
  double noise_rate = 0.015;      ///< share of channels with a thermal photo-electron
  double typical_light = 8.0;     ///< range of light of an edge fibre, photo-electrons
  double slope_spread = 0.2;      ///< typical slope along alpha
  double secondary_share = 0.02;  ///< pairs made by a secondary electron
  double bright = 8.0;            ///< photo-electrons in the weaker channel above which secondaries abound ...
  double bright_share = 0.25;     ///< ... and their share there (both from simulated hits)

  [[nodiscard]] double variance(const plane& p, const cluster_light& light) const {
    const double width = p.channel_width;
    const double single = width * width / 12.0;
    if (light.size <= 1) return single;
    if (light.size > 2) return width * width * light.size * light.size / 12.0;
    const double tilt = fibre.row_separation * slope_spread;
    const double pair = (fibre.overlap() * fibre.overlap() + tilt * tilt) / 12.0;
    const double distance = light.least - 1.0;
    const double noise = 2.0 * noise_rate * std::exp(-0.5 * distance * distance) / std::sqrt(2.0 * constants::pi);
    const double crossing = fibre.overlap() / width / typical_light;
    const double floor = light.least < bright ? secondary_share : bright_share;
    const double wrong = floor + (1.0 - floor) * noise / (noise + crossing);
    return (1.0 - wrong) * pair + wrong * (0.25 * width * width + single);
  }
};

static_assert(cluster_resolution<uniform_resolution>);
static_assert(cluster_resolution<fibre_resolution>);

}  // namespace scifi
