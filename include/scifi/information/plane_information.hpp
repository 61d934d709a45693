// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>
#include <concepts>

#include <scifi/geometry/fibre.hpp>
#include <scifi/geometry/plane.hpp>

namespace scifi {

/// A policy that foresees the variance (mm^2, positive) of what a plane will measure of a particle that crosses it at alpha (mm, plane frame).
template <class R>
concept plane_information = requires(const R r, const plane& p, double alpha) {
  { r.variance(p, alpha) } -> std::convertible_to<double>;
};

/// d^2/12 of the channel width everywhere: a detector that says which channel was hit and no more.
struct channel_information {
  [[nodiscard]] double variance(const plane& p, double) const { return p.channel_width * p.channel_width / 12.0; }
};

/// What a doublet of fibres says: a crossing in the strip that the edge fibres of two channels share lights both and is known to the width of that
/// strip, any other lights one channel and is known to the width that no neighbour shares; both uniform, width^2/12.
struct doublet_information {
  fibre_doublet fibre{};
  [[nodiscard]] double variance(const plane& p, double alpha) const {
    const double channel = p.channel_at(alpha);
    const double from_border = std::abs(channel - std::floor(channel) - 0.5) * p.channel_width;
    const double width = from_border < 0.5 * fibre.overlap() ? fibre.overlap() : p.channel_width - fibre.overlap();
    return width * width / 12.0;
  }
};

static_assert(plane_information<channel_information>);
static_assert(plane_information<doublet_information>);

}  // namespace scifi
