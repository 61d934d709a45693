// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <scifi/io/input_error.hpp>

namespace scifi {

/// A file that appears under its name complete or not at all: it is written as NAME.partial in the same folder, and `commit` forces it
/// to disk, renames and closes it. Without `commit` the partial file is removed, unless it was to be kept. Two writers of one file at a time
/// are refused. What is not a regular file (a pipe, a terminal, anything under /dev) is written in place. POSIX.
class atomic_file {
 public:
  /// Throws input_error when the file cannot be created, for the name is what was given wrongly. The first `kept` bytes of the partial file,
  /// which must be there, are kept: writing goes on behind them.
  explicit atomic_file(const std::filesystem::path& path, std::uintmax_t kept = 0) : name_(path.string()) {
    namespace fs = std::filesystem;
    std::error_code none;
    if (name_.empty()) fail_to_open("the name is empty");
    if (path.filename().empty() || fs::is_directory(path, none)) fail_to_open("is a folder");
    in_place_ = written_in_place(path);
    final_ = in_place_ ? path : behind_links(path);
    if (!in_place_ && fs::exists(final_, none) && ::access(final_.c_str(), W_OK) != 0) fail_to_open(std::strerror(errno));
    temporary_ = in_place_ ? final_ : partial_of(path);
    open_alone();
    try {
      if (!in_place_) keep_first(kept);
    } catch (...) {
      ::close(descriptor_);
      throw;
    }
  }
  atomic_file(const atomic_file&) = delete;
  atomic_file& operator=(const atomic_file&) = delete;
  ~atomic_file() {
    if (descriptor_ < 0) return;
    if (!in_place_ && !keep_) ::unlink(temporary_.c_str());
    ::close(descriptor_);
  }

  /// The name itself, or what a symbolic link of that name leads to.
  [[nodiscard]] static std::filesystem::path behind_links(const std::filesystem::path& path) {
    std::error_code none;
    return std::filesystem::is_symlink(path, none) ? std::filesystem::weakly_canonical(path, none) : path;
  }
  /// Where a file of this name is written until it is complete.
  [[nodiscard]] static std::filesystem::path partial_of(const std::filesystem::path& path) { return behind_links(path).string() + ".partial"; }
  /// True for what is not a regular file: it cannot be replaced whole.
  [[nodiscard]] static bool written_in_place(const std::filesystem::path& path) {
    std::error_code none;
    return path.string().starts_with("/dev/") || (std::filesystem::exists(path, none) && !std::filesystem::is_regular_file(path, none));
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

  /// Gives the file its name. Throws std::system_error when that fails; the partial file is then removed, unless it was to be kept.
  void commit() {
    synchronise();
    if (!in_place_ && ::rename(temporary_.c_str(), final_.c_str()) != 0) fail_to_write(errno);
    close();
  }

  /// Closes the file under its partial name, which it returns (for one written in place, its name). Throws std::system_error.
  std::string keep_partial() {
    synchronise();
    close();
    return temporary_.string();
  }
  /// From now on the partial file stays, however this ends: another writer is to go on with it.
  void keep_if_abandoned() { keep_ = true; }

  [[nodiscard]] const std::string& name() const { return name_; }

 private:
  [[noreturn]] void fail_to_open(const std::string& why) const { throw input_error(name_, 0, "", "cannot be written: " + why); }
  [[noreturn]] void fail_to_write(int why) const { throw std::system_error(why, std::generic_category(), name_ + ": could not be written"); }

  /// Nobody else may be writing it. The name may have gone to another file before the lock was there (the other one was done): then once more.
  void open_alone() {
    while (true) {
      constexpr mode_t read_write_for_all = 0666;  // less what the umask takes away
      descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, read_write_for_all);
      if (descriptor_ < 0) fail_to_open(std::strerror(errno));
      if (in_place_) return;
      if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
        ::close(descriptor_);
        fail_to_open("another process is writing " + temporary_.string());
      }
      struct stat opened {};
      struct stat named {};
      if (::fstat(descriptor_, &opened) == 0 && ::stat(temporary_.c_str(), &named) == 0 && opened.st_ino == named.st_ino && opened.st_dev == named.st_dev) return;
      ::close(descriptor_);
    }
  }

  void keep_first(std::uintmax_t kept) {
    const off_t size = ::lseek(descriptor_, 0, SEEK_END);
    if (size < 0 || static_cast<std::uintmax_t>(size) < kept) fail_to_open(temporary_.string() + " is shorter than what is to be kept of it");
    const auto end = static_cast<off_t>(kept);
    if (size != end && ::ftruncate(descriptor_, end) != 0) fail_to_write(errno);
    if (::lseek(descriptor_, end, SEEK_SET) != end) fail_to_write(errno);
  }

  void synchronise() const {
    if (!in_place_ && ::fsync(descriptor_) != 0) fail_to_write(errno);
  }
  void close() {
    const int descriptor = descriptor_;
    descriptor_ = -1;
    if (::close(descriptor) != 0) fail_to_write(errno);
  }

  std::string name_;
  std::filesystem::path final_, temporary_;
  int descriptor_ = -1;
  bool in_place_ = false, keep_ = false;
};

}  // namespace scifi
