// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>

namespace scifi {

/// Where in a page its data belong.
inline constexpr std::string_view page_data_mark = "@SCIFI_DATA@";

/// A page with a JSON text (UTF-8) put where `page_data_mark` stands, once, inside a script element of type application/json. Each '<' of the text is
/// written as its JSON escape, which reads as the same, so that no text in the data can end the element. Throws std::invalid_argument when the page has
/// no such mark.
[[nodiscard]] inline std::string page_with_data(std::string_view page, std::string_view json) {
  const std::size_t mark = page.find(page_data_mark);
  if (mark == std::string_view::npos) throw std::invalid_argument("the page has no mark " + std::string(page_data_mark) + " for its data");
  std::string out;
  out.reserve(page.size() + json.size() + json.size() / 16);
  out += page.substr(0, mark);
  for (const char c : json) {
    if (c == '<') out += "\\u003c";
    else out += c;
  }
  out += page.substr(mark + page_data_mark.size());
  return out;
}

}  // namespace scifi
