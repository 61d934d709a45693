// SPDX-License-Identifier: MPL-2.0
#include <scifi/io/atomic_file.hpp>

#include <filesystem>
#include <string>
#include <system_error>

#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

namespace {

namespace fs = std::filesystem;
using scifi::atomic_file;
using scifi::input_error;
using namespace scifi::test;

}  // namespace

TEST_CASE("a file appears under its name when it is complete, and replaces an older one", "[io]") {
  const temporary_folder folder;
  const auto path = folder.file("out.csv", "old");
  {
    atomic_file file(path);
    file.write("a");
    file.write("bc");
    CHECK(content_of(path) == "old");
    file.commit();
  }
  CHECK(content_of(path) == "abc");
  CHECK_FALSE(fs::exists(folder / "out.csv.partial"));
}

TEST_CASE("a file given up leaves nothing behind", "[io]") {
  const temporary_folder folder;
  {
    atomic_file file(folder / "out.csv");
    file.write("abc");
  }
  CHECK(fs::is_empty(folder.path()));
}

TEST_CASE("a partial file is kept when asked for", "[io]") {
  const temporary_folder folder;
  std::string name;
  {
    atomic_file file(folder / "out.csv");
    file.write("abc");
    name = file.keep_partial();
  }
  CHECK(name == (folder / "out.csv.partial").string());
  CHECK(content_of(name) == "abc");
  CHECK_FALSE(fs::exists(folder / "out.csv"));
}

TEST_CASE("another writer goes on with what is kept of a partial file", "[io]") {
  const temporary_folder folder;
  {
    atomic_file file(folder / "out.csv");
    file.write("abcdef");
    file.keep_if_abandoned();
  }
  CHECK(content_of(atomic_file::partial_of(folder / "out.csv")) == "abcdef");
  CHECK(message_of<input_error>([&] { atomic_file file(folder / "out.csv", 7); }).find("out.csv.partial is shorter than what is to be kept of it") != std::string::npos);
  CHECK(content_of(folder / "out.csv.partial") == "abcdef");
  {
    atomic_file file(folder / "out.csv", 4);
    file.write("x");
    file.commit();
  }
  CHECK(content_of(folder / "out.csv") == "abcdx");
  atomic_file(folder / "out.csv", 0).commit();
  CHECK(content_of(folder / "out.csv").empty());
}

TEST_CASE("a file that is being written is not written by another one", "[io]") {
  const temporary_folder folder;
  atomic_file file(folder / "out.csv");
  file.write("abc");
  CHECK(message_of<input_error>([&] { atomic_file other(folder / "out.csv"); }).find("out.csv: cannot be written: another process is writing ") != std::string::npos);
  file.commit();
  CHECK(content_of(folder / "out.csv") == "abc");
  atomic_file(folder / "out.csv").commit();
}

TEST_CASE("a symbolic link is written through", "[io]") {
  const temporary_folder folder;
  const auto target = folder.file("target", "old");
  fs::create_symlink(target, folder / "link");
  atomic_file file(folder / "link");
  file.write("new");
  file.commit();
  CHECK(fs::is_symlink(folder / "link"));
  CHECK(content_of(target) == "new");
}

TEST_CASE("a name that cannot be written is refused at once", "[io]") {
  const temporary_folder folder;
  CHECK(message_of<input_error>([&] { atomic_file file(folder.path()); }) == folder.path().string() + ": cannot be written: is a folder");
  CHECK(message_of<input_error>([&] { atomic_file file(folder / "none" / "out.csv"); }) ==
        (folder / "none" / "out.csv").string() + ": cannot be written: No such file or directory");
  CHECK(message_of<input_error>([&] { atomic_file file(""); }) == ": cannot be written: the name is empty");
}

TEST_CASE("a full disk is an error when the text is written", "[io]") {
  if (!fs::is_character_file("/dev/full")) return;  // the device exists on Linux alone
  atomic_file file("/dev/full");
  const std::string message = message_of<std::system_error>([&] { file.write("abc"); });
  CHECK(message == "/dev/full: could not be written: No space left on device");
  CHECK(fs::is_character_file("/dev/full"));
}

TEST_CASE("a device is written in place and not replaced", "[io]") {
  atomic_file file("/dev/null");
  file.write("abc");
  file.commit();
  CHECK(fs::is_character_file("/dev/null"));
}
