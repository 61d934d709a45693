// SPDX-License-Identifier: MPL-2.0
#include <scifi/conditions/sqlite_handle.hpp>

#include <chrono>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>

#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

namespace {

using scifi::input_error;
using scifi::detail::sqlite_handle;
using scifi::detail::sqlite_transaction;
using namespace scifi::test;
constexpr auto reading = sqlite_handle::access::read;
constexpr auto writing = sqlite_handle::access::write;
constexpr std::chrono::milliseconds patience(50);

}  // namespace

TEST_CASE("values come back from a table as they were put in", "[conditions]") {
  const temporary_folder folder;
  sqlite_handle handle(folder / "a.db", writing, patience);
  handle.run("CREATE TABLE t (a INTEGER, b TEXT, c BLOB)");
  const std::string bytes("\0\xff'\n;", 5);
  auto insert = handle.prepare("INSERT INTO t VALUES (?1, ?2, ?3)");
  insert.bind(1, std::optional<std::int64_t>()).bind(2, "it's").bind_bytes(3, bytes);
  CHECK_FALSE(insert.step());
  auto select = handle.prepare("SELECT a, b, c FROM t");
  REQUIRE(select.step());
  CHECK(select.is_null(0));
  CHECK(select.bytes(1) == "it's");
  CHECK(select.bytes(2) == bytes);
  CHECK_FALSE(select.step());
  CHECK(handle.number("SELECT count(*) FROM t") == 1);
}

TEST_CASE("a transaction that is not committed leaves nothing", "[conditions]") {
  const temporary_folder folder;
  sqlite_handle handle(folder / "a.db", writing, patience);
  handle.run("CREATE TABLE t (a INTEGER)");
  {
    const sqlite_transaction given_up(handle);
    handle.run("INSERT INTO t VALUES (1)");
  }
  CHECK(handle.number("SELECT count(*) FROM t") == 0);
  sqlite_transaction kept(handle);
  handle.run("INSERT INTO t VALUES (1)");
  kept.commit();
  CHECK(handle.number("SELECT count(*) FROM t") == 1);
}

TEST_CASE("a reader does not write, and does not make a file", "[conditions]") {
  const temporary_folder folder;
  { sqlite_handle(folder / "a.db", writing, patience).run("CREATE TABLE t (a INTEGER)"); }
  sqlite_handle reader(folder / "a.db", reading, patience);
  CHECK(message_of<input_error>([&] { reader.run("INSERT INTO t VALUES (1)"); }) ==
        (folder / "a.db").string() + ": cannot be written: attempt to write a readonly database");
  CHECK(message_of<input_error>([&] { sqlite_handle(folder / "none.db", reading, patience); }) ==
        (folder / "none.db").string() + ": cannot be opened: there is no such file");
  CHECK_FALSE(std::filesystem::exists(folder / "none.db"));
}

TEST_CASE("a name that is special to SQLite is a file like any other", "[conditions]") {
  const temporary_folder folder;
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path());
  { sqlite_handle(":memory:", writing, patience).run("CREATE TABLE t (a INTEGER)"); }
  CHECK(std::filesystem::file_size(":memory:") > 0);
  std::filesystem::current_path(before);
}

TEST_CASE("what is no database that can be written is refused", "[conditions]") {
  const temporary_folder folder;
  const auto refused = [&](const std::filesystem::path& path) {
    return without(path.string(), message_of<input_error>([&] { sqlite_handle(path, writing, patience).run("CREATE TABLE t (a INTEGER)"); }));
  };
  CHECK(refused(folder.path()) == ": is not a regular file");
  CHECK(refused("") == ": the name is empty");
  CHECK(refused("/dev/null") == ": is not a regular file");
  CHECK(refused(folder / "none" / "a.db") == ": cannot be opened: unable to open database file");
  CHECK(refused(folder.file("text.db", std::string(2000, 'x'))) == ": is not a conditions store: it is no SQLite database");
}

TEST_CASE("who waits for another process in vain is told so", "[conditions]") {
  const temporary_folder folder;
  sqlite_handle one(folder / "a.db", writing, patience);
  one.run("CREATE TABLE t (a INTEGER)");
  sqlite_handle other(folder / "a.db", writing, patience);
  const sqlite_transaction busy(one);
  CHECK(message_of<std::runtime_error>([&] { sqlite_transaction second(other); }) ==
        (folder / "a.db").string() + ": is being written by another process that does not finish");
}
