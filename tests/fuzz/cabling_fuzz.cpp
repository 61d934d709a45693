// SPDX-License-Identifier: MPL-2.0
#include <string_view>

#include <scifi/io/cabling_text.hpp>

#include "fuzz/target.hpp"

namespace scifi::fuzz {

inline const registered cabling_target("cabling", [](std::string_view bytes) {
  // Two planes of three channels: whole files are short.
  static const detector small = [] {
    detector d = trackers();
    d.trackers.resize(1);
    d.trackers[0].stations.resize(1);
    d.trackers[0].stations[0].planes.resize(2);
    for (plane& p : d.trackers[0].stations[0].planes) p.channels = 3;
    return d;
  }();
  const auto path = as_file(bytes);
  read_or_refuse([&] {
    const cabling_map map = read_cabling(path, small);
    require(!map.cables().empty(), "a cabling connects something");
    for (const auto& [id, cable] : map.cables()) require(map.channel_of(cable) == id, "a cable has one channel");
  });
});

}  // namespace scifi::fuzz
