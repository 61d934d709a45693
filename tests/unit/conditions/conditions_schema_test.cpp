// SPDX-License-Identifier: MPL-2.0
#include <scifi/conditions/conditions_schema.hpp>

#include <chrono>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

namespace {

using scifi::input_error;
using namespace scifi::detail;
using namespace scifi::test;

sqlite_handle open(const std::filesystem::path& path) { return {path, sqlite_handle::access::write, std::chrono::milliseconds(50)}; }

constexpr const char* a_row = "INSERT INTO condition VALUES (1, 'geometry', NULL, 1, 2, 10, 20, 'a', 'b', 1, 'x', x'64')";

std::string refused(const std::filesystem::path& path) {
  return without(path.string(), message_of<input_error>([&] { check_conditions_tables(open(path)); }));
}

}  // namespace

TEST_CASE("a new file becomes a store, once", "[conditions]") {
  const temporary_folder folder;
  for (int i = 0; i < 2; ++i) {
    auto handle = open(folder / "a.db");
    make_conditions_tables(handle);
    check_conditions_tables(handle);
    CHECK(handle.number("PRAGMA user_version") == scifi::conditions_version);
    CHECK(handle.number("SELECT count(*) FROM condition") == i);
    if (i == 0) handle.run(a_row);
  }
}

TEST_CASE("no statement changes, removes or replaces a record", "[conditions]") {
  const temporary_folder folder;
  auto handle = open(folder / "a.db");
  make_conditions_tables(handle);
  handle.run(a_row);
  const std::string name = (folder / "a.db").string();
  const auto says = [&](const char* sql) { return without(name, message_of<std::runtime_error>([&] { handle.run(sql); })); };
  CHECK(says("UPDATE condition SET comment = 'other'") == ": a condition that was recorded is never changed");
  CHECK(says("DELETE FROM condition") == ": a condition that was recorded is never removed");
  CHECK(says("INSERT OR REPLACE INTO condition VALUES (1, 'geometry', NULL, 1, 2, 10, 20, 'a', 'other', 1, 'x', x'64')") ==
        ": a condition that was recorded is never replaced");
  CHECK(says("INSERT INTO condition VALUES (1, 'geometry', NULL, 1, 2, 10, 20, 'a', 'other', 1, 'x', x'64') ON CONFLICT DO UPDATE SET comment = 'other'") ==
        ": a condition that was recorded is never replaced");
  CHECK(handle.number("SELECT count(*) FROM condition WHERE comment = 'b'") == 1);
}

TEST_CASE("the tables refuse what is no interval and no time", "[conditions]") {
  const temporary_folder folder;
  auto handle = open(folder / "a.db");
  make_conditions_tables(handle);
  for (const char* values : {"'geometry', NULL, 3, 2, 10, 20, 'a', 'b', 1, 'x', x'64'", "'geometry', NULL, -1, 2, 10, 20, 'a', 'b', 1, 'x', x'64'",
                             "'geometry', NULL, 1, 2, 30, 20, 'a', 'b', 1, 'x', x'64'", "'geometry', -1, 1, 2, 10, 20, 'a', 'b', 1, 'x', x'64'",
                             "'geometry', NULL, 'x', 2, 10, 20, 'a', 'b', 1, 'x', x'64'"}) {
    CHECK_THROWS_AS(handle.run(std::string("INSERT INTO condition VALUES (NULL, ") + values + ")"), std::runtime_error);
  }
  CHECK(handle.number("SELECT count(*) FROM condition") == 0);
}

TEST_CASE("a file that is something else is refused and left as it is", "[conditions]") {
  const temporary_folder folder;
  CHECK(refused(folder.file("empty.db", "")) == ": is not a conditions store: it is empty");
  const auto other = folder / "other.db";
  open(other).run("CREATE TABLE theirs (a INTEGER)");
  {
    auto handle = open(other);
    make_conditions_tables(handle);
    CHECK(handle.number("SELECT count(*) FROM sqlite_master") == 1);
  }
  CHECK(refused(other) == ": is not a conditions store: it is an SQLite database of another program");
}

TEST_CASE("a store of a newer version is refused, as is one that has lost its guards", "[conditions]") {
  const temporary_folder folder;
  const auto path = folder / "a.db";
  {
    auto handle = open(path);
    make_conditions_tables(handle);
    handle.run("PRAGMA user_version = 2");
  }
  CHECK(refused(path) == ": is a conditions store of version 2, newer than version 1, the newest that can be read");
  open(path).run("PRAGMA user_version = 1; DROP TRIGGER condition_never_updated");
  CHECK(refused(path) == ": somebody has removed what keeps its records from being changed");
}
