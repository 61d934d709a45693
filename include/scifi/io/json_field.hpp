// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

#include <scifi/io/input_error.hpp>
#include <scifi/io/text_source.hpp>

namespace scifi {

/// A value in a JSON document that knows the way to itself, so that an error names file, line (0 for none) and field
/// (`trackers[1].stations[0].position`). The document must outlive it. Whatever is asked for and is not there throws input_error.
class json_field {
 public:
  json_field(const nlohmann::json& document, std::string file, long line = 0) : value_(&document), file_(std::move(file)), line_(line) {}

  [[noreturn]] void fail(std::string reason) const { throw input_error(file_, line_, path_, std::move(reason)); }

  [[nodiscard]] bool has(const char* key) const { return value_->is_object() && value_->contains(key); }
  [[nodiscard]] bool is_null() const { return value_->is_null(); }
  [[nodiscard]] const nlohmann::json& value() const { return *value_; }

  /// A member of an object.
  [[nodiscard]] json_field at(const char* key) const {
    if (!value_->is_object()) fail("is not an object");
    const json_field member(*this, path_.empty() ? key : path_ + '.' + key);
    const auto found = value_->find(key);
    if (found == value_->end()) member.fail("is missing");
    return member.pointing_to(*found);
  }

  /// Number of elements of an array.
  [[nodiscard]] std::size_t size() const {
    if (!value_->is_array()) fail("is not an array");
    return value_->size();
  }
  /// An element of an array.
  [[nodiscard]] json_field element(std::size_t i) const {
    if (i >= size()) fail("has no element " + std::to_string(i));
    return json_field(*this, path_ + '[' + std::to_string(i) + ']').pointing_to((*value_)[i]);
  }

  [[nodiscard]] std::string text() const {
    if (!value_->is_string()) fail("is not text");
    return value_->get<std::string>();
  }
  /// A finite number.
  [[nodiscard]] double number() const {
    // A list or an object is not written out: it may be nested deeper than the stack is.
    if (value_->is_structured()) fail(std::string(value_->is_array() ? "a list" : "an object") + " is not a number");
    if (!value_->is_number()) fail(in_quotes(value_->dump()) + " is not a number");
    const double x = value_->get<double>();
    if (!std::isfinite(x)) fail("is not a finite number");
    return x;
  }
  /// A finite number above zero.
  [[nodiscard]] double positive() const {
    const double x = number();
    if (!(x > 0.0)) fail(value_->dump() + " is not above zero");
    return x;
  }
  /// A whole number from `lowest` to `highest`.
  [[nodiscard]] int whole_number(int lowest = std::numeric_limits<int>::min(), int highest = std::numeric_limits<int>::max()) const {
    const double x = number();
    if (x != std::floor(x)) fail(value_->dump() + " is not a whole number");
    if (x < lowest || x > highest) fail(value_->dump() + " is outside " + std::to_string(lowest) + " .. " + std::to_string(highest));
    return static_cast<int>(x);
  }

 private:
  json_field(const json_field& parent, std::string path) : value_(parent.value_), file_(parent.file_), path_(std::move(path)), line_(parent.line_) {}
  [[nodiscard]] json_field pointing_to(const nlohmann::json& value) const {
    json_field out = *this;
    out.value_ = &value;
    return out;
  }

  const nlohmann::json* value_;
  std::string file_, path_;
  long line_;
};

/// Parses one JSON document; `line` is where it begins. Throws input_error with the line of a mistake.
[[nodiscard]] inline nlohmann::json parse_json(std::string_view text, const std::string& file, long line = 1) {
  try {
    return nlohmann::json::parse(text);
  } catch (const nlohmann::json::parse_error& e) {
    const std::string_view before = text.substr(0, e.byte > 0 ? e.byte - 1 : 0);
    for (const char c : before) line += c == '\n' ? 1 : 0;
    // The library's sentence begins with its own name and position in brackets.
    const std::string_view whole = e.what();
    const std::size_t colon = whole.find(": ");
    throw input_error(file, line, "", "is not JSON: " + std::string(colon == std::string_view::npos ? whole : whole.substr(colon + 2)));
  } catch (const nlohmann::json::out_of_range& e) {
    // A number beyond double; where it stands is known only of a text of one line.
    const std::string_view whole = e.what();
    const std::size_t bracket = whole.find("] ");
    throw input_error(file, text.find('\n') == std::string_view::npos ? line : 0, "",
                      "is not usable JSON: " + std::string(bracket == std::string_view::npos ? whole : whole.substr(bracket + 2)));
  }
}

/// Reads a file, plain or gzip, that is one JSON document. Throws input_error when it is not.
[[nodiscard]] inline nlohmann::json read_json(const std::filesystem::path& path) {
  const std::string text = text_of_file(path);
  if (text.empty()) throw input_error(path.string(), 0, "", "the file is empty");
  return parse_json(text, path.string());
}

}  // namespace scifi
