// SPDX-License-Identifier: MPL-2.0
#include <cstddef>
#include <string_view>
#include <vector>

#include <scifi/io/csv.hpp>
#include <scifi/io/line_reader.hpp>

#include "fuzz/target.hpp"

namespace scifi::fuzz {

// Plain and packed text, line by line, split at its commas.
inline const registered text_target("text", [](std::string_view bytes) {
  const auto path = as_file(bytes);
  read_or_refuse([&] {
    line_reader lines(path, std::size_t{1} << 16);
    std::vector<std::string_view> fields;
    std::string_view line;
    for (long n = 1; lines.next(line); ++n) {
      require(lines.line() == n && line.find('\n') == std::string_view::npos, "a line is one line");
      split_fields(line, fields);
      require(!fields.empty(), "a line has a field");
    }
  });
});

}  // namespace scifi::fuzz
