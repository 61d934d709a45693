// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <scifi/geometry/channel_id.hpp>

namespace scifi {

/// What the read-out says about one channel of one event: its light in photo-electrons, positive.
struct digit {
  channel_id id;
  double npe = 0.0;
};

}  // namespace scifi
