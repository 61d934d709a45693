// SPDX-License-Identifier: MPL-2.0
#include <string_view>

#include <scifi/io/field_map_reader.hpp>

#include "fuzz/target.hpp"

namespace scifi::fuzz {

inline const registered field_map_target("field_map", [](std::string_view bytes) {
  const auto path = as_file(bytes);
  read_or_refuse([&] {
    const auto map = read_field_map(path, outside_map::nearest);
    require(map(vector<double, 3>(1.0, 2.0, 3.0)).allFinite(), "a field is finite near the origin");
  });
});

}  // namespace scifi::fuzz
