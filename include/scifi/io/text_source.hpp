// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include <unistd.h>
#include <zlib.h>

#include <scifi/io/input_error.hpp>

namespace scifi {

/// The bytes of a file, read once from front to back in big blocks, of a pipe as they come. A file that begins with the gzip magic number is unpacked, whatever
/// its name; several gzip members in a row are one text. Memory does not depend on the length of the file. Not copyable, not for sharing.
class text_source {
 public:
  /// Throws input_error when the file cannot be opened or read.
  explicit text_source(const std::filesystem::path& path) : name_(path.string()), file_(std::fopen(path.c_str(), "rb")) {
    if (!file_) fail(std::string("cannot be opened: ") + std::strerror(errno));
    std::error_code none;
    const std::uintmax_t bytes = std::filesystem::is_regular_file(path, none) ? std::filesystem::file_size(path, none) : 0;
    if (bytes > 0 && !none) size_ = bytes;
    fill();
    if (available_ == 1) read_some();
    constexpr unsigned char first = 0x1f;
    constexpr unsigned char second = 0x8b;
    compressed_ = available_ >= 2 && input_[0] == first && input_[1] == second;
    if (!compressed_) return;
    constexpr int gzip_with_largest_window = 16 + MAX_WBITS;
    if (inflateInit2(&stream_, gzip_with_largest_window) != Z_OK) fail("cannot be unpacked: zlib did not start");
    inflating_ = true;
    in_member_ = true;
  }
  text_source(const text_source&) = delete;
  text_source& operator=(const text_source&) = delete;
  ~text_source() {
    if (inflating_) inflateEnd(&stream_);
  }

  /// Reads up to `count` bytes to `out` and returns how many; 0 at the end. Throws input_error for a read error or broken gzip data.
  [[nodiscard]] std::size_t read(char* out, std::size_t count) {
    if (compressed_) return inflate_some(out, count);
    if (available_ == 0) fill();
    const std::size_t n = count < available_ ? count : available_;
    std::memcpy(out, input_.data() + position_, n);
    take(n);
    return n;
  }

  /// Name of the file, for messages.
  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] bool compressed() const { return compressed_; }
  /// Bytes of the file (packed if it is packed) used so far.
  [[nodiscard]] std::uintmax_t consumed() const { return consumed_; }
  /// Bytes of the file, or nothing for a pipe.
  [[nodiscard]] std::optional<std::uintmax_t> size() const { return size_; }

 private:
  struct closer {
    void operator()(std::FILE* f) const { std::fclose(f); }
  };

  [[noreturn]] void fail(std::string reason) const { throw input_error(name_, 0, "", std::move(reason)); }

  void fill() {
    position_ = 0;
    available_ = 0;
    read_some();
  }
  /// What a pipe holds now is enough: what is written into it bit by bit is read so.
  void read_some() {
    const ssize_t n = ::read(::fileno(file_.get()), input_.data() + available_, input_.size() - available_);
    if (n < 0) fail(std::string("cannot be read: ") + std::strerror(errno));
    available_ += static_cast<std::size_t>(n);
  }
  void take(std::size_t n) {
    position_ += n;
    available_ -= n;
    consumed_ += n;
  }

  [[nodiscard]] std::size_t inflate_some(char* out, std::size_t count) {
    std::size_t produced = 0;
    while (produced == 0) {
      if (available_ == 0) fill();
      if (available_ == 0) {
        if (in_member_) fail("the gzip data end too early: the file is truncated");
        return 0;
      }
      if (!in_member_) {
        inflateReset(&stream_);
        in_member_ = true;
      }
      stream_.next_in = input_.data() + position_;
      stream_.avail_in = static_cast<uInt>(available_);
      stream_.next_out = reinterpret_cast<Bytef*>(out);
      stream_.avail_out = static_cast<uInt>(count);
      const int result = inflate(&stream_, Z_NO_FLUSH);
      take(available_ - stream_.avail_in);
      produced = count - stream_.avail_out;
      if (result == Z_STREAM_END) in_member_ = false;
      if (result != Z_STREAM_END && result != Z_OK && result != Z_BUF_ERROR)
        fail(std::string("the gzip data are damaged: ") + (stream_.msg != nullptr ? stream_.msg : "unknown zlib error"));
    }
    return produced;
  }

  static constexpr std::size_t block_size = std::size_t{1} << 16;
  std::string name_;
  std::unique_ptr<std::FILE, closer> file_;
  std::vector<unsigned char> input_ = std::vector<unsigned char>(block_size);
  std::size_t position_ = 0, available_ = 0;
  std::uintmax_t consumed_ = 0;
  std::optional<std::uintmax_t> size_;
  z_stream stream_{};
  bool compressed_ = false, inflating_ = false, in_member_ = false;
};

/// The text of a file, unpacked if it is gzip. Throws input_error, also for more than `most` bytes: a small packed file may hold very much.
[[nodiscard]] inline std::string text_of_file(const std::filesystem::path& path, std::size_t most = std::size_t{1} << 28) {
  text_source source(path);
  std::string text;
  constexpr std::size_t block = std::size_t{1} << 16;
  std::size_t n = 0;
  do {
    const std::size_t old = text.size();
    if (old > most) throw input_error(source.name(), 0, "", "is longer than " + std::to_string(most) + " bytes");
    text.resize(old + block);
    n = source.read(text.data() + old, block);
    text.resize(old + n);
  } while (n > 0);
  return text;
}

}  // namespace scifi
