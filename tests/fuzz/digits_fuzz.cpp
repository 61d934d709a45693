// SPDX-License-Identifier: MPL-2.0
#include <string_view>

#include <scifi/core/scalar.hpp>
#include <scifi/event/event.hpp>
#include <scifi/io/digit_reader.hpp>

#include "fuzz/target.hpp"

namespace scifi::fuzz {

inline const registered digits_target("digits", [](std::string_view bytes) {
  const auto path = as_file(bytes);
  read_or_refuse([&] {
    digit_reader reader(path, trackers());
    event e;
    for (long last = -1; reader.read(e); last = e.number) {
      require(e.number > last, "event numbers grow");
      require(!e.digits.empty(), "an event of a table has a digit");
      for (const digit& d : e.digits) {
        const plane* p = trackers().find_plane(d.id);
        require(p != nullptr && p->has_channel(d.id.channel), "a digit has a channel of the detector");
        require(is_finite(d.npe) && d.npe >= 0.0, "light is finite and not negative");
      }
    }
  });
});

}  // namespace scifi::fuzz
