// SPDX-License-Identifier: MPL-2.0
#include <string_view>

#include <scifi/io/channel_list_reader.hpp>

#include "fuzz/target.hpp"

namespace scifi::fuzz {

inline const registered channel_list_target("channel_list", [](std::string_view bytes) {
  const auto path = as_file(bytes);
  read_or_refuse([&] {
    for (const channel_id& id : read_channel_list(path, trackers())) require(trackers().find_plane(id)->has_channel(id.channel), "a channel is one of the detector");
  });
});

}  // namespace scifi::fuzz
