// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstdint>
#include <string>

#include <scifi/conditions/sqlite_handle.hpp>
#include <scifi/io/input_error.hpp>

namespace scifi {

/// Version of the tables of a conditions store as this library writes them.
inline constexpr std::int64_t conditions_version = 1;

namespace detail {

/// Marks an SQLite file as a conditions store: the letters SFCD.
inline constexpr std::int64_t conditions_application = 0x53464344;

// Triggers, for nothing that was recorded may change. An INSERT OR REPLACE would remove a row without the trigger on DELETE, hence the third.
inline constexpr const char* conditions_tables = R"sql(
CREATE TABLE condition (
  id INTEGER PRIMARY KEY AUTOINCREMENT,
  kind TEXT NOT NULL,
  tracker INTEGER CHECK (tracker >= 0),
  first_run INTEGER NOT NULL CHECK (first_run >= 0),
  last_run INTEGER CHECK (last_run >= first_run),
  recorded INTEGER NOT NULL,
  written INTEGER NOT NULL CHECK (written >= recorded),
  source TEXT NOT NULL,
  comment TEXT NOT NULL,
  length INTEGER NOT NULL,
  sha256 TEXT NOT NULL,
  document BLOB NOT NULL
) STRICT;
CREATE INDEX condition_by_kind ON condition (kind, recorded, id);
CREATE TRIGGER condition_never_updated BEFORE UPDATE ON condition
BEGIN SELECT RAISE(ABORT, 'a condition that was recorded is never changed'); END;
CREATE TRIGGER condition_never_deleted BEFORE DELETE ON condition
BEGIN SELECT RAISE(ABORT, 'a condition that was recorded is never removed'); END;
CREATE TRIGGER condition_never_replaced BEFORE INSERT ON condition WHEN EXISTS (SELECT 1 FROM condition WHERE id = NEW.id)
BEGIN SELECT RAISE(ABORT, 'a condition that was recorded is never replaced'); END;
)sql";

/// Makes the tables in a file that is new (or empty). Two processes may try at once.
inline void make_conditions_tables(sqlite_handle& handle) {
  sqlite_transaction transaction(handle);
  const bool fresh = handle.number("PRAGMA application_id") == 0 && handle.number("PRAGMA user_version") == 0 &&
                     handle.number("SELECT count(*) FROM sqlite_master") == 0;
  if (!fresh) return;
  handle.run(conditions_tables);
  handle.run("PRAGMA application_id = " + std::to_string(conditions_application));
  handle.run("PRAGMA user_version = " + std::to_string(conditions_version));
  transaction.commit();
}

/// Throws input_error unless the file is a conditions store that this library can read.
inline void check_conditions_tables(const sqlite_handle& handle) {
  const auto refuse = [&](const std::string& why) { throw input_error(handle.file(), 0, "", why); };
  if (handle.number("PRAGMA application_id") != conditions_application) {
    const bool empty = handle.number("SELECT count(*) FROM sqlite_master") == 0;
    refuse(empty ? "is not a conditions store: it is empty" : "is not a conditions store: it is an SQLite database of another program");
  }
  const std::int64_t version = handle.number("PRAGMA user_version");
  if (version > conditions_version)
    refuse("is a conditions store of version " + std::to_string(version) + ", newer than version " + std::to_string(conditions_version) +
           ", the newest that can be read");
  if (handle.number("SELECT count(*) FROM sqlite_master WHERE type = 'trigger' AND name IN "
                    "('condition_never_updated', 'condition_never_deleted', 'condition_never_replaced')") != 3)
    refuse("somebody has removed what keeps its records from being changed");
}

}  // namespace detail
}  // namespace scifi
