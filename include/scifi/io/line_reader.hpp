// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstddef>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <scifi/io/input_error.hpp>
#include <scifi/io/text_source.hpp>

namespace scifi {

/// The lines of a text file, plain or gzip, one at a time. Line ends are LF or CR LF, the last may be missing; a UTF-8 byte order mark
/// at the start is dropped.
class line_reader {
 public:
  static constexpr std::size_t default_longest_line = std::size_t{1} << 20;

  /// A line of more than `longest_line` bytes is an error: it bounds the memory. Throws input_error as text_source does.
  explicit line_reader(const std::filesystem::path& path, std::size_t longest_line = default_longest_line)
      : source_(path), longest_(longest_line), buffer_(first_size) {}

  /// Sets `out` to the next line, valid until the next call, and returns true; false at the end of the file.
  /// Throws input_error, with the line, for a line that is too long and where the source fails.
  [[nodiscard]] bool next(std::string_view& out) {
    std::size_t searched = 0;
    while (true) {
      const char* const from = buffer_.data() + begin_;
      const std::size_t size = end_ - begin_;
      const void* const found = size > searched ? std::memchr(from + searched, '\n', size - searched) : nullptr;
      if (found != nullptr || (ended_ && size > 0)) {
        const std::size_t length = found != nullptr ? static_cast<std::size_t>(static_cast<const char*>(found) - from) : size;
        begin_ += found != nullptr ? length + 1 : length;
        out = std::string_view(from, length);
        if (!out.empty() && out.back() == '\r') out.remove_suffix(1);
        constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
        if (line_ == 0 && out.starts_with(byte_order_mark)) out.remove_prefix(byte_order_mark.size());
        ++line_;
        return true;
      }
      if (ended_) return false;
      searched = size;
      refill();
    }
  }

  /// Number of the line that `next` gave last, from 1.
  [[nodiscard]] long line() const { return line_; }
  [[nodiscard]] const std::string& name() const { return source_.name(); }
  [[nodiscard]] const text_source& source() const { return source_; }

 private:
  void refill() {
    if (begin_ > 0) {
      std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
      end_ -= begin_;
      begin_ = 0;
    }
    if (end_ > longest_) throw input_error(name(), line_ + 1, "", "the line is longer than " + std::to_string(longest_) + " bytes");
    if (end_ == buffer_.size()) buffer_.resize(2 * buffer_.size());
    try {
      const std::size_t n = source_.read(buffer_.data() + end_, buffer_.size() - end_);
      end_ += n;
      ended_ = n == 0;
    } catch (const input_error& e) {
      throw input_error(e.file(), line_ + 1, e.field(), e.reason());
    }
  }

  static constexpr std::size_t first_size = std::size_t{1} << 16;
  text_source source_;
  std::size_t longest_;
  std::vector<char> buffer_;
  std::size_t begin_ = 0, end_ = 0;
  bool ended_ = false;
  long line_ = 0;
};

}  // namespace scifi
