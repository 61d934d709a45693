// SPDX-License-Identifier: MPL-2.0
#include <string_view>

#include <scifi/io/raw_reader.hpp>
#include <scifi/readout_to_digit/readout.hpp>

#include "fuzz/target.hpp"

namespace scifi::fuzz {

inline const registered raw_target("raw", [](std::string_view bytes) {
  const auto path = as_file(bytes);
  read_or_refuse([&] {
    const readout_layout layout;
    raw_reader reader(path, layout);
    raw_event e;
    for (long last = -1; reader.read(e); last = e.number) {
      require(e.number > last, "event numbers grow");
      for (const raw_count& c : e.counts) {
        require(layout.contains(c.from), "a count has a channel of the read-out");
        require(c.adc >= 0 && c.adc <= layout.largest_count, "a count is one that the ADC can give");
      }
    }
  });
});

}  // namespace scifi::fuzz
