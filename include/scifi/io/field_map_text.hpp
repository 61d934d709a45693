// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <scifi/core/units.hpp>
#include <scifi/io/input_error.hpp>
#include <scifi/io/line_reader.hpp>

namespace scifi::detail {

/// One point of a field map as its file gives it, in mm and (MeV/c)/(e mm): the coordinates of the grid, then the components of the field.
struct field_map_row {
  std::array<double, 6> value{};
  long line = 0;
};

/// On which side of a plane through 0 a file gives the field, and how its components change sign beyond: +1 even, -1 odd.
struct field_map_mirror {
  std::size_t axis = 0;
  std::array<int, 3> sign{};
  long line = 0;
};

/// What a field map file says, row by row; the grid is not yet looked at.
class field_map_text {
 public:
  /// Throws input_error with file, line, key or column, and the reason.
  explicit field_map_text(const std::filesystem::path& path) : lines_(path) {
    read_header();
    while (next_words()) read_row();
    if (rows.empty()) throw input_error(lines_.name(), 0, "", "the field map has no points");
  }

  bool cylindrical = false;
  std::vector<std::string_view> names;  ///< coordinates, then components, in the order of field_map_row
  std::vector<field_map_mirror> mirrors;
  std::vector<field_map_row> rows;
  [[nodiscard]] const std::string& file() const { return lines_.name(); }
  [[nodiscard]] std::size_t dimensions() const { return cylindrical ? 2 : 3; }

 private:
  [[noreturn]] void fail(std::string_view field, std::string reason) const { throw input_error(lines_.name(), lines_.line(), std::string(field), std::move(reason)); }

  /// Splits the next line that is not blank and no comment at blanks and commas.
  [[nodiscard]] bool next_words() {
    constexpr std::string_view blanks = " \t,";
    std::string_view line;
    while (lines_.next(line)) {
      line = line.substr(0, line.find('#'));
      words_.clear();
      for (std::size_t at = line.find_first_not_of(blanks); at != std::string_view::npos; at = line.find_first_not_of(blanks, at)) {
        const std::size_t end = std::min(line.find_first_of(blanks, at), line.size());
        words_.push_back(line.substr(at, end - at));
        at = end;
      }
      if (!words_.empty()) return true;
    }
    return false;
  }

  void read_header() {
    if (!next_words()) throw input_error(lines_.name(), 0, "", "the file is empty");
    if (words_ != std::vector<std::string_view>{"scifi", "field", "map"}) fail("", "is not a field map: the first line must read 'scifi field map'");
    std::optional<double> length, field;
    bool grid = false;
    while (next_words()) {
      const std::string key(words_[0]);
      if (key == "columns") {
        for (const auto& [there, name] : {std::pair{grid, "grid"}, std::pair{length.has_value(), "length"}, std::pair{field.has_value(), "field"}})
          if (!there) fail(name, "is missing above the columns");
        length_ = *length;
        field_ = *field;
        return read_columns();
      }
      if (key == "mirror") {
        if (!grid) fail("mirror", "stands before the grid that it mirrors");
        read_mirror();
        continue;
      }
      if (key != "grid" && key != "length" && key != "field") fail("", in_quotes(key) + " is no key of a field map: grid, length, field, mirror, columns");
      if (words_.size() != 2) fail(key, "needs one word");
      if (key == "grid" ? grid : key == "length" ? length.has_value() : field.has_value()) fail(key, "is given twice");
      if (key == "grid") {
        grid = true;
        cylindrical = one_of(key, {{"cylindrical", 1.0}, {"cartesian", 0.0}}) > 0.0;
        if (cylindrical) names = {"r", "z", "br", "bz"};
        else names = {"x", "y", "z", "bx", "by", "bz"};
      } else if (key == "length") {
        length = one_of(key, {{"mm", units::mm}, {"cm", units::cm}, {"m", units::m}});
      } else {
        field = one_of(key, {{"T", units::tesla}, {"mT", 1e-3 * units::tesla}, {"kG", 0.1 * units::tesla}, {"G", 1e-4 * units::tesla}});
      }
    }
    throw input_error(lines_.name(), 0, "columns", "is missing: the file has no points");
  }

  [[nodiscard]] double one_of(const std::string& key, const std::vector<std::pair<std::string_view, double>>& known) const {
    std::string names_known;
    for (const auto& [name, value] : known) {
      if (words_[1] == name) return value;
      names_known += (names_known.empty() ? "" : ", ") + std::string(name);
    }
    fail(key, in_quotes(words_[1]) + " is not known: " + names_known);
  }

  /// mirror z br odd bz even
  void read_mirror() {
    const std::size_t d = dimensions(), components = names.size() - d;
    if (words_.size() != 2 + 2 * components) fail("mirror", "needs a coordinate and, for each component, its name and 'odd' or 'even'");
    field_map_mirror m;
    m.line = lines_.line();
    m.axis = static_cast<std::size_t>(std::find(names.begin(), names.end(), words_[1]) - names.begin());
    if (m.axis >= d || (cylindrical && m.axis == 0)) fail("mirror", in_quotes(words_[1]) + " is not a coordinate that can be mirrored");
    for (const field_map_mirror& other : mirrors)
      if (other.axis == m.axis) fail("mirror", in_quotes(words_[1]) + " is mirrored already");
    for (std::size_t i = 2; i < words_.size(); i += 2) {
      const auto c = static_cast<std::size_t>(std::find(names.begin(), names.end(), words_[i]) - names.begin());
      if (c < d || c >= names.size()) fail("mirror", in_quotes(words_[i]) + " is not a component of the field");
      if (words_[i + 1] != "odd" && words_[i + 1] != "even") fail("mirror", in_quotes(words_[i + 1]) + " is neither 'odd' nor 'even'");
      if (m.sign[c - d] != 0) fail("mirror", in_quotes(words_[i]) + " is named twice");
      m.sign[c - d] = words_[i + 1] == "odd" ? -1 : 1;
    }
    mirrors.push_back(m);
  }

  void read_columns() {
    if (words_.size() != names.size() + 1) fail("columns", "must name " + std::to_string(names.size()) + " columns");
    for (std::size_t i = 1; i < words_.size(); ++i) {
      const auto place = static_cast<std::size_t>(std::find(names.begin(), names.end(), words_[i]) - names.begin());
      if (place == names.size()) fail("columns", in_quotes(words_[i]) + " is not a column of this grid");
      if (std::find(order_.begin(), order_.end(), place) != order_.end()) fail("columns", in_quotes(words_[i]) + " is named twice");
      order_.push_back(place);
    }
  }

  void read_row() {
    if (words_.size() != order_.size())
      fail("", std::to_string(words_.size()) + (words_.size() == 1 ? " number" : " numbers") + " where " + std::to_string(order_.size()) + " belong");
    field_map_row row;
    row.line = lines_.line();
    for (std::size_t i = 0; i < order_.size(); ++i) {
      const std::size_t place = order_[i];
      double number = 0.0;
      const auto [end, error] = std::from_chars(words_[i].data(), words_[i].data() + words_[i].size(), number);
      if (error == std::errc::result_out_of_range) fail(names[place], in_quotes(words_[i]) + " is too large or too small for a number");
      if (error != std::errc{} || end != words_[i].data() + words_[i].size()) fail(names[place], in_quotes(words_[i]) + " is not a number");
      if (!std::isfinite(number)) fail(names[place], in_quotes(words_[i]) + " is not a finite number");
      row.value[place] = number * (place < dimensions() ? length_ : field_);
    }
    rows.push_back(row);
  }

  line_reader lines_;
  std::vector<std::string_view> words_;
  std::vector<std::size_t> order_;  // column of the file -> place in names
  double length_ = 1.0, field_ = 1.0;
};

}  // namespace scifi::detail
