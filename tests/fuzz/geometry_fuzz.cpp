// SPDX-License-Identifier: MPL-2.0
#include <string_view>

#include <nlohmann/json.hpp>

#include <scifi/io/digit_check.hpp>
#include <scifi/io/geometry_json.hpp>
#include <scifi/io/geometry_json_writer.hpp>

#include "fuzz/target.hpp"

namespace scifi::fuzz {

inline const registered geometry_target("geometry", [](std::string_view bytes) {
  nlohmann::ordered_json written;
  read_or_refuse([&] {
    const nlohmann::json document = parse_json(bytes, "input");
    const detector d = geometry_from_json(document, "input");
    const fibre_doublet fibre = fibre_from_json(document, "input");
    require(!d.trackers.empty(), "a geometry has a tracker");
    const digit_check check(d, "line");  // takes memory for every channel
    written = geometry_to_json(d, fibre);
  });
  // What was understood can be said, and is understood again.
  if (!written.is_null()) static_cast<void>(geometry_from_json(nlohmann::json::parse(written.dump()), "written"));
});

}  // namespace scifi::fuzz
