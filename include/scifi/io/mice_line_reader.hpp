// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstddef>
#include <deque>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <scifi/io/input_error.hpp>
#include <scifi/io/line_reader.hpp>

namespace scifi {

/// The statements of a MiceModules file: a line of words each, comments from // on left out; a brace is a statement of its own, wherever it stands.
class mice_line_reader {
 public:
  using statement = std::vector<std::string>;

  /// Throws input_error when the file cannot be opened.
  explicit mice_line_reader(const std::filesystem::path& path) : lines_(path, longest_line) {}

  /// Sets `out` to the next statement, which has a word at least, and returns true; false at the end of the file.
  /// Throws input_error, with the line, for a line that is too long or not ASCII text.
  [[nodiscard]] bool next(statement& out) {
    std::string_view line;
    while (waiting_.empty()) {
      if (!lines_.next(line)) return false;
      split(line);
    }
    out = std::move(waiting_.front());
    waiting_.pop_front();
    return true;
  }

  /// Line of the statement that `next` gave last, from 1.
  [[nodiscard]] long line() const { return lines_.line(); }
  [[nodiscard]] const std::string& name() const { return lines_.name(); }
  [[noreturn]] void fail(std::string field, std::string reason) const { throw input_error(name(), line(), std::move(field), std::move(reason)); }

 private:
  void split(std::string_view line) {
    if (line.find('\0') != std::string_view::npos) fail("", "is not ASCII text: it holds a zero byte (UTF-16?)");
    line = line.substr(0, line.find("//"));  // a name in a comment may be in any encoding
    statement words;
    std::string word;
    const auto end_statement = [&] {
      if (!words.empty()) waiting_.push_back(std::exchange(words, {}));
    };
    const auto end_word = [&] {
      if (word.empty()) return;
      if (word == "{" || word == "}") {
        end_statement();
        waiting_.push_back({std::exchange(word, {})});
      } else {
        words.push_back(std::exchange(word, {}));
      }
    };
    for (const char c : line) {
      const auto byte = static_cast<unsigned char>(c);
      constexpr unsigned char first_printable = 0x20;
      constexpr unsigned char last_printable = 0x7e;
      if (c == ' ' || c == '\t') end_word();
      else if (byte < first_printable || byte > last_printable) fail("", "is not ASCII text: it holds the byte " + std::to_string(byte));
      else word += c;
    }
    end_word();
    end_statement();
  }

  static constexpr std::size_t longest_line = 4096;
  line_reader lines_;
  std::deque<statement> waiting_;
};

}  // namespace scifi
