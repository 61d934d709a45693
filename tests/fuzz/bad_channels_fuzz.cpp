// SPDX-License-Identifier: MPL-2.0
#include <string_view>

#include <scifi/io/bad_channels_text.hpp>

#include "fuzz/target.hpp"

namespace scifi::fuzz {

inline const registered bad_channels_target("bad_channels", [](std::string_view bytes) {
  const auto path = as_file(bytes);
  read_or_refuse([&] { static_cast<void>(read_bad_channels(path)); });
});

}  // namespace scifi::fuzz
