// SPDX-License-Identifier: MPL-2.0
#include <string_view>

#include <scifi/event/event.hpp>
#include <scifi/io/mice_json.hpp>

#include "fuzz/target.hpp"

namespace scifi::fuzz {

inline const registered mice_json_target("mice_json", [](std::string_view bytes) {
  const auto path = as_file(bytes);
  read_or_refuse([&] {
    mice_json_reader reader(path, trackers());
    event e;
    for (long next = 0; reader.read(e); ++next) {
      require(e.number == next, "events are numbered through");
      for (const digit& d : e.digits) require(trackers().find_plane(d.id) != nullptr && d.npe >= 0.0, "a digit is one of the detector");
    }
  });
});

}  // namespace scifi::fuzz
