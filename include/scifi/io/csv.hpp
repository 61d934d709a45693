// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <charconv>
#include <concepts>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <scifi/core/scalar.hpp>
#include <scifi/io/input_error.hpp>
#include <scifi/io/line_reader.hpp>

namespace scifi {

namespace detail {

/// Position of the comma that ends the field at `start`, or the end of the line; commas between double quotes are passed over.
[[nodiscard]] inline std::size_t end_of_quoted_field(std::string_view line, std::size_t start) {
  bool inside = false;
  for (std::size_t i = start; i < line.size(); ++i) {
    if (line[i] == '"') inside = !inside;
    if (line[i] == ',' && !inside) return i;
  }
  return line.size();
}

}  // namespace detail

/// Splits a line at its commas into `out`: blanks around a field and double quotes around its text are dropped. A comma between quotes
/// belongs to the field; a doubled quote inside stays doubled; a quote that is not closed keeps the rest of the line.
inline void split_fields(std::string_view line, std::vector<std::string_view>& out) {
  const auto trimmed = [](const char* from, const char* to) {
    const auto blank = [](char c) { return c == ' ' || c == '\t'; };
    while (from != to && blank(*from)) ++from;
    while (from != to && blank(to[-1])) --to;
    return std::string_view(from, static_cast<std::size_t>(to - from));
  };
  const char* const end = line.data() + line.size();
  const char* start = line.data();
  out.clear();
  const char* at = start;
  for (; at != end && *at != '"'; ++at) {
    if (*at != ',') continue;
    out.push_back(trimmed(start, at));
    start = at + 1;
  }
  if (at == end) {
    out.push_back(trimmed(start, end));
    return;
  }
  // From here on quotes are minded: a few times slower.
  for (auto from = static_cast<std::size_t>(start - line.data()); from <= line.size();) {
    const std::size_t to = detail::end_of_quoted_field(line, from);
    std::string_view field = trimmed(line.data() + from, line.data() + to);
    if (field.size() >= 2 && field.front() == '"' && field.back() == '"') field = field.substr(1, field.size() - 2);
    out.push_back(field);
    from = to + 1;
  }
}

/// The rows of a table with a header line, of which some columns, found by their names, are wanted.
class csv_reader {
 public:
  /// Throws input_error when the file cannot be read, is empty, or lacks a wanted column or has it twice.
  csv_reader(const std::filesystem::path& path, std::vector<std::string> wanted) : lines_(path), wanted_(std::move(wanted)) {
    std::string_view line;
    if (!lines_.next(line)) throw input_error(lines_.name(), 0, "", "the file is empty");
    split_fields(line, fields_);
    width_ = fields_.size();
    for (const std::string& name : wanted_) {
      std::size_t found = width_;
      for (std::size_t i = 0; i < width_; ++i) {
        if (fields_[i] != name) continue;
        if (found != width_) throw input_error(lines_.name(), 1, name, "the header names this column twice");
        found = i;
      }
      if (found == width_) throw input_error(lines_.name(), 1, name, "the header has no column of this name, it reads " + in_quotes(line));
      columns_.push_back(found);
    }
  }

  /// Goes to the next row that is not blank; false at the end. Throws input_error where the number of fields is not that of the header.
  [[nodiscard]] bool next_row() {
    std::string_view line;
    do {
      if (!lines_.next(line)) return false;
    } while (line.find_first_not_of(" \t\r") == std::string_view::npos);
    split_fields(line, fields_);
    if (fields_.size() != width_)
      fail("", std::to_string(fields_.size()) + (fields_.size() == 1 ? " field" : " fields") + " where the header names " + std::to_string(width_));
    return true;
  }

  /// The wanted field of this row (counted as in `wanted`) as a whole number. Throws input_error where it is none or does not fit.
  template <std::integral Integer>
  [[nodiscard]] Integer whole_number(std::size_t wanted) const {
    return parse<Integer>(wanted, " is not a whole number");
  }

  /// The wanted field of this row as a finite number. Throws input_error where it is none.
  [[nodiscard]] double number(std::size_t wanted) const {
    const double value = parse<double>(wanted, " is not a number");
    if (!is_finite(value)) fail(wanted_[wanted], in_quotes(field(wanted)) + " is not a finite number");
    return value;
  }

  /// The wanted field of this row as a number, which may be "nan": what was not measured. Throws input_error where it is neither.
  [[nodiscard]] double number_or_nan(std::size_t wanted) const {
    const double value = parse<double>(wanted, " is not a number");
    if (!is_finite(value) && value == value) fail(wanted_[wanted], in_quotes(field(wanted)) + " is not a finite number");
    return value;
  }

  /// The wanted field of this row as it stands there, valid until the next row.
  [[nodiscard]] std::string_view text(std::size_t wanted) const { return field(wanted); }

  /// Throws input_error at this row.
  [[noreturn]] void fail(std::string column, std::string reason) const {
    throw input_error(lines_.name(), lines_.line(), std::move(column), std::move(reason));
  }

  [[nodiscard]] long line() const { return lines_.line(); }
  [[nodiscard]] const std::string& column_name(std::size_t wanted) const { return wanted_[wanted]; }
  [[nodiscard]] const text_source& source() const { return lines_.source(); }

 private:
  [[nodiscard]] std::string_view field(std::size_t wanted) const { return fields_[columns_[wanted]]; }

  template <class Number>
  [[nodiscard]] Number parse(std::size_t wanted, const char* complaint) const {
    const std::string_view text = field(wanted);
    Number value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error == std::errc{} && end == text.data() + text.size()) return value;
    if (text.empty()) fail(wanted_[wanted], "the field is empty");
    if (error == std::errc::result_out_of_range) fail(wanted_[wanted], in_quotes(text) + " is too large or too small for a number");
    fail(wanted_[wanted], in_quotes(text) + complaint);
  }

  line_reader lines_;
  std::vector<std::string> wanted_;
  std::vector<std::size_t> columns_;  // of the wanted fields
  std::vector<std::string_view> fields_;
  std::size_t width_ = 0;
};

}  // namespace scifi
