// SPDX-License-Identifier: MPL-2.0
#include <string_view>
#include <vector>

#include <scifi/io/event_rows.hpp>
#include <scifi/io/truth_reader.hpp>

#include "fuzz/target.hpp"

namespace scifi::fuzz {

inline const registered truth_target("truth", [](std::string_view bytes) {
  const auto path = as_file(bytes);
  read_or_refuse([&] {
    truth_reader reader(path, trackers());
    std::vector<crossing> crossings;
    while (reader.next_event() != event_rows::no_more) {
      reader.read(reader.next_event(), crossings);
      for (const crossing& c : crossings)
        require(trackers().find_plane({c.tracker, c.station, c.plane, 0}) != nullptr && c.position.allFinite() && c.momentum.allFinite(), "a crossing is one of a plane");
    }
  });
});

}  // namespace scifi::fuzz
