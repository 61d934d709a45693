// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <scifi/io/input_error.hpp>
#include <scifi/io/line_reader.hpp>

namespace scifi {

/// The rows of a text file, plain or gzip, that has a fixed number of whole numbers between blanks in every line; blank lines are passed over.
class whole_number_rows {
 public:
  /// `columns` names the numbers of a row, for messages. Throws input_error when the file cannot be read.
  whole_number_rows(const std::filesystem::path& path, std::vector<std::string> columns)
      : lines_(path), columns_(std::move(columns)), values_(columns_.size()) {}

  /// Goes to the next row; false at the end. Throws input_error where a line is not plain text, has too few or too many numbers, or something
  /// that is none.
  [[nodiscard]] bool next() {
    constexpr std::string_view blanks = " \t\r";
    std::string_view line;
    while (lines_.next(line)) {
      check_text(line);
      std::size_t fields = 0;
      for (std::size_t at = line.find_first_not_of(blanks); at != std::string_view::npos; at = line.find_first_not_of(blanks, at)) {
        const std::size_t end = std::min(line.find_first_of(blanks, at), line.size());
        if (fields < values_.size()) values_[fields] = number(line.substr(at, end - at), columns_[fields]);
        ++fields;
        at = end;
      }
      if (fields == 0) continue;
      if (fields != values_.size())
        fail("", std::to_string(fields) + (fields == 1 ? " number" : " numbers") + " where " + std::to_string(values_.size()) + " belong");
      return true;
    }
    return false;
  }

  /// A number of this row, counted as in `columns`.
  [[nodiscard]] int operator[](std::size_t column) const { return values_[column]; }
  /// The same, which must lie in lowest .. highest. Throws input_error where it does not.
  [[nodiscard]] int within(std::size_t column, int lowest, int highest) const {
    const int value = values_[column];
    if (value < lowest || value > highest)
      fail(columns_[column], std::to_string(value) + " is outside " + std::to_string(lowest) + " .. " + std::to_string(highest));
    return value;
  }

  /// Throws input_error at this row.
  [[noreturn]] void fail(std::string column, std::string reason) const {
    throw input_error(lines_.name(), lines_.line(), std::move(column), std::move(reason));
  }
  [[nodiscard]] long line() const { return lines_.line(); }
  [[nodiscard]] const std::string& name() const { return lines_.name(); }

 private:
  void check_text(std::string_view line) const {
    for (const char c : line) {
      const auto byte = static_cast<unsigned char>(c);
      constexpr std::string_view hex = "0123456789ABCDEF";
      if ((byte < 0x20 && c != '\t' && c != '\r') || byte >= 0x7f)
        fail("", std::string("is not plain ASCII text: byte 0x") + hex[byte >> 4] + hex[byte & 0xf]);
    }
  }

  [[nodiscard]] int number(std::string_view text, const std::string& column) const {
    int value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error == std::errc::result_out_of_range) fail(column, in_quotes(text) + " is too large or too small for a number");
    if (error != std::errc{} || end != text.data() + text.size()) fail(column, in_quotes(text) + " is not a whole number");
    return value;
  }

  line_reader lines_;
  std::vector<std::string> columns_;
  std::vector<int> values_;
};

}  // namespace scifi
