// SPDX-License-Identifier: MPL-2.0
#include <cmath>
#include <string_view>

#include <scifi/io/mice_geometry.hpp>

#include "fuzz/target.hpp"

namespace scifi::fuzz {

// The file may refer to itself: it is input.dat.
inline const registered mice_modules_target("mice_modules", [](std::string_view bytes) {
  const auto path = as_file(bytes, "input.dat");
  read_or_refuse([&] {
    const mice_geometry g = read_mice_geometry(path);
    require(!g.detector.trackers.empty() && g.field.size() == g.detector.trackers.size(), "a geometry has a tracker, and for each says the field or that it does not");
    for (const auto& t : g.detector.trackers)
      for (const auto& s : t.stations) require(s.in_tracker.origin.allFinite() && std::isfinite(s.in_tracker.angle) && !s.planes.empty(), "a station is somewhere");
  });
});

}  // namespace scifi::fuzz
