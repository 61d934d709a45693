// SPDX-License-Identifier: MPL-2.0
#include <string_view>

#include <scifi/io/calibration_json.hpp>

#include "fuzz/target.hpp"

namespace scifi::fuzz {

inline const registered calibration_target("calibration", [](std::string_view bytes) {
  read_or_refuse([&] {
    const readout_calibration c = calibration_from_json(parse_json(bytes, "input"), "input");
    require(c.size() > 0, "a calibration is one of a channel");
  });
});

}  // namespace scifi::fuzz
