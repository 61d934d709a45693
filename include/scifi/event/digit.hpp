// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <concepts>

#include <scifi/geometry/channel_id.hpp>

namespace scifi {

/// What the read-out says about one channel of one event: its light in photo-electrons, positive.
struct digit {
  channel_id id;
  double npe = 0.0;
};

[[nodiscard]] constexpr const channel_id& channel_of(const digit& d) { return d.id; }
[[nodiscard]] constexpr double light_of(const digit& d) { return d.npe; }

/// A digit, of this library or of a host framework: beside its type stand `channel_of(d)`, the channel_id, and `light_of(d)`, its photo-electrons. The chain
/// asks no more of a digit, so that those of a host are used where they are. Laws: neither changes the digit; both are cheap.
template <class D>
concept digit_record = std::movable<D> && requires(const D& d) {
  { channel_of(d) } -> std::convertible_to<channel_id>;
  { light_of(d) } -> std::convertible_to<double>;
};
static_assert(digit_record<digit>);

}  // namespace scifi
