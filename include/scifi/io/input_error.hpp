// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

namespace scifi {

/// What is wrong with a file that was handed in: which file, where in it, and why. `what()` reads `file:line: field: reason`;
/// parts that do not apply are left out.
class input_error : public std::runtime_error {
 public:
  /// `line` counts from 1, 0 when there is none; `field` is a column of a table or a path in a JSON document, or empty.
  input_error(std::string file, long line, std::string field, std::string reason)
      : std::runtime_error(sentence(file, line, field, reason)), file_(std::move(file)), field_(std::move(field)), reason_(std::move(reason)), line_(line) {}

  [[nodiscard]] const std::string& file() const { return file_; }
  [[nodiscard]] long line() const { return line_; }
  [[nodiscard]] const std::string& field() const { return field_; }
  [[nodiscard]] const std::string& reason() const { return reason_; }

 private:
  [[nodiscard]] static std::string sentence(const std::string& file, long line, const std::string& field, const std::string& reason) {
    std::string out = file;
    if (line > 0) out += ':' + std::to_string(line);
    out += ": ";
    if (!field.empty()) out += field + ": ";
    return out + reason;
  }

  std::string file_, field_, reason_;
  long line_;
};

/// Text from a file as it may appear in a message: quoted, at most 40 characters of it, control characters shown as '?'.
[[nodiscard]] inline std::string in_quotes(std::string_view text) {
  constexpr std::size_t longest = 40;
  std::string out = "'";
  for (const char c : text.substr(0, longest)) out += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? '?' : c;
  return out + (text.size() > longest ? "...'" : "'");
}

}  // namespace scifi
