// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cerrno>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>

#include <fcntl.h>
#include <unistd.h>

#include <scifi/io/input_error.hpp>

namespace scifi {

/// A file that appears under its name complete or not at all: it is written as NAME.partial in the same folder, and `commit` forces it
/// to disk, closes it and renames it. Without `commit` the partial file is removed, unless `keep_partial` was asked for.
/// What is not a regular file (a pipe, a terminal, anything under /dev) is written in place. POSIX.
class atomic_file {
 public:
  /// Throws input_error when the file cannot be created, for the name is what was given wrongly.
  explicit atomic_file(const std::filesystem::path& path) : name_(path.string()) {
    namespace fs = std::filesystem;
    std::error_code none;
    if (name_.empty()) fail_to_open("the name is empty");
    if (path.filename().empty() || fs::is_directory(path, none)) fail_to_open("is a folder");
    in_place_ = name_.starts_with("/dev/") || (fs::exists(path, none) && !fs::is_regular_file(path, none));
    final_ = !in_place_ && fs::is_symlink(path, none) ? fs::weakly_canonical(path, none) : path;
    if (!in_place_ && fs::exists(final_, none) && ::access(final_.c_str(), W_OK) != 0) fail_to_open(std::strerror(errno));
    temporary_ = in_place_ ? final_ : fs::path(final_.string() + ".partial");
    constexpr mode_t read_write_for_all = 0666;  // less what the umask takes away
    descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | (in_place_ ? 0 : O_TRUNC) | O_CLOEXEC, read_write_for_all);
    if (descriptor_ < 0) fail_to_open(std::strerror(errno));
  }
  atomic_file(const atomic_file&) = delete;
  atomic_file& operator=(const atomic_file&) = delete;
  ~atomic_file() {
    if (descriptor_ < 0) return;
    ::close(descriptor_);
    if (!in_place_) ::unlink(temporary_.c_str());
  }

  /// Throws std::system_error, naming the file, when not all of it could be written (disk full).
  void write(std::string_view text) {
    while (!text.empty()) {
      const ssize_t n = ::write(descriptor_, text.data(), text.size());
      if (n < 0 && errno == EINTR) continue;
      if (n < 0) fail_to_write(errno);
      text.remove_prefix(static_cast<std::size_t>(n));
    }
  }

  /// Gives the file its name. Throws std::system_error when that fails; the partial file is then removed.
  void commit() {
    flush();
    if (!in_place_ && ::rename(temporary_.c_str(), final_.c_str()) != 0) {
      const int why = errno;
      ::unlink(temporary_.c_str());
      fail_to_write(why);
    }
  }

  /// Closes the file under its partial name, which it returns (for one written in place, its name). Throws std::system_error.
  std::string keep_partial() {
    flush();
    return temporary_.string();
  }

  [[nodiscard]] const std::string& name() const { return name_; }

 private:
  [[noreturn]] void fail_to_open(const std::string& why) const { throw input_error(name_, 0, "", "cannot be written: " + why); }
  [[noreturn]] void fail_to_write(int why) const { throw std::system_error(why, std::generic_category(), name_ + ": could not be written"); }

  void flush() {
    if (!in_place_ && ::fsync(descriptor_) != 0) fail_to_write(errno);
    const int descriptor = descriptor_;
    descriptor_ = -1;
    if (::close(descriptor) == 0) return;
    const int why = errno;
    if (!in_place_) ::unlink(temporary_.c_str());
    fail_to_write(why);
  }

  std::string name_;
  std::filesystem::path final_, temporary_;
  int descriptor_ = -1;
  bool in_place_ = false;
};

}  // namespace scifi
