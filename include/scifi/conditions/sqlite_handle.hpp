// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>

#include <sqlite3.h>

#include <scifi/io/input_error.hpp>

namespace scifi::detail {

/// What SQLite's result code means for a user of `file`: a wrong or unusable file is an input_error, all else a std::runtime_error.
[[noreturn]] inline void throw_sqlite_error(const std::string& file, int code, const std::string& message) {
  switch (code & 0xff) {
    case SQLITE_NOTADB: throw input_error(file, 0, "", "is not a conditions store: it is no SQLite database");
    case SQLITE_CORRUPT: throw input_error(file, 0, "", "is damaged: " + message);
    case SQLITE_READONLY: throw input_error(file, 0, "", "cannot be written: " + message);
    case SQLITE_CANTOPEN:
    case SQLITE_PERM: throw input_error(file, 0, "", "cannot be opened: " + message);
    case SQLITE_BUSY: throw std::runtime_error(file + ": is being written by another process that does not finish");
    default: throw std::runtime_error(file + ": " + message);
  }
}

/// A prepared statement. What is bound must outlive the steps. Parameters count from 1, columns from 0, as in SQLite.
class sqlite_statement {
 public:
  sqlite_statement(sqlite3* database, const std::string& file, const std::string& sql) : file_(&file) {
    sqlite3_stmt* raw = nullptr;
    const int code = sqlite3_prepare_v2(database, sql.c_str(), static_cast<int>(sql.size()) + 1, &raw, nullptr);
    statement_.reset(raw);
    check(code);
  }

  sqlite_statement& bind(int i, std::int64_t value) { return check(sqlite3_bind_int64(statement_.get(), i, value)); }
  sqlite_statement& bind(int i, std::optional<std::int64_t> value) {
    return value ? bind(i, *value) : check(sqlite3_bind_null(statement_.get(), i));
  }
  sqlite_statement& bind(int i, std::string_view value) {
    return check(sqlite3_bind_text64(statement_.get(), i, value.data(), value.size(), SQLITE_STATIC, SQLITE_UTF8));
  }
  sqlite_statement& bind_bytes(int i, std::string_view value) {
    return check(sqlite3_bind_blob64(statement_.get(), i, value.data(), value.size(), SQLITE_STATIC));
  }

  /// Goes to the next row; false when there is none.
  [[nodiscard]] bool step() {
    const int code = sqlite3_step(statement_.get());
    if (code == SQLITE_ROW) return true;
    if (code != SQLITE_DONE) check(code);
    return false;
  }

  [[nodiscard]] bool is_null(int i) const { return sqlite3_column_type(statement_.get(), i) == SQLITE_NULL; }
  [[nodiscard]] std::int64_t number(int i) const { return sqlite3_column_int64(statement_.get(), i); }
  /// The bytes of a text or blob.
  [[nodiscard]] std::string bytes(int i) const {
    const void* const data = sqlite3_column_blob(statement_.get(), i);
    const auto size = static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), i));
    return data == nullptr ? std::string() : std::string(static_cast<const char*>(data), size);
  }

 private:
  struct finaliser {
    void operator()(sqlite3_stmt* s) const { sqlite3_finalize(s); }
  };
  sqlite_statement& check(int code) {
    // Not sqlite3_errmsg: another thread may change that text while it is read.
    if (code != SQLITE_OK) throw_sqlite_error(*file_, code, sqlite3_errstr(code));
    return *this;
  }

  const std::string* file_;
  std::unique_ptr<sqlite3_stmt, finaliser> statement_;
};

/// An open SQLite file. Statements may be prepared and stepped in several threads at once: SQLite's own lock is on.
class sqlite_handle {
 public:
  enum class access { read, write };

  /// Opens the file; with access::write one that is not there is made. Throws input_error when that cannot be.
  sqlite_handle(const std::filesystem::path& path, access how, std::chrono::milliseconds patience) : file_(std::make_unique<std::string>(path.string())) {
    std::error_code none;
    const auto status = std::filesystem::status(path, none);
    if (path.empty()) throw input_error(*file_, 0, "", "the name is empty");
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) throw input_error(*file_, 0, "", "is not a regular file");
    if (how == access::read && !std::filesystem::exists(status)) throw input_error(*file_, 0, "", "cannot be opened: there is no such file");
    // Readers too ask for write access and do without where there is none: what a killed writer left half done must be undone by the next reader.
    const int flags = SQLITE_OPEN_FULLMUTEX | SQLITE_OPEN_READWRITE | (how == access::write ? SQLITE_OPEN_CREATE : 0);
    // An absolute name is never one that is special to SQLite, such as ":memory:".
    sqlite3* raw = nullptr;
    const int code = sqlite3_open_v2(std::filesystem::absolute(path).c_str(), &raw, flags, nullptr);
    database_.reset(raw);
    if (code != SQLITE_OK) throw_sqlite_error(*file_, code, raw != nullptr ? sqlite3_errmsg(raw) : sqlite3_errstr(code));
    sqlite3_extended_result_codes(raw, 1);
    sqlite3_busy_timeout(raw, static_cast<int>(patience.count()));
    if (how == access::write && sqlite3_db_readonly(raw, "main") == 1) throw input_error(*file_, 0, "", "cannot be written: no permission");
    if (how == access::read) run("PRAGMA query_only = ON");
  }

  [[nodiscard]] sqlite_statement prepare(const std::string& sql) const { return sqlite_statement(database_.get(), *file_, sql); }

  /// Runs statements that give no rows.
  void run(const std::string& sql) {
    const int code = sqlite3_exec(database_.get(), sql.c_str(), nullptr, nullptr, nullptr);
    if (code != SQLITE_OK) throw_sqlite_error(*file_, code, sqlite3_errmsg(database_.get()));
  }

  /// The number that a statement without parameters gives.
  [[nodiscard]] std::int64_t number(const std::string& sql) const {
    sqlite_statement s = prepare(sql);
    return s.step() ? s.number(0) : 0;
  }
  [[nodiscard]] std::int64_t last_row() const { return sqlite3_last_insert_rowid(database_.get()); }
  [[nodiscard]] const std::string& file() const { return *file_; }

 private:
  struct closer {
    void operator()(sqlite3* d) const { sqlite3_close(d); }
  };
  std::unique_ptr<std::string> file_;  // stays where it is when the handle moves: statements look at it
  std::unique_ptr<sqlite3, closer> database_;
};

/// Everything between its construction and `commit`, or nothing. Takes the right to write at once, so that what it reads stays true.
class sqlite_transaction {
 public:
  explicit sqlite_transaction(sqlite_handle& handle) : handle_(&handle) { handle.run("BEGIN IMMEDIATE"); }
  sqlite_transaction(const sqlite_transaction&) = delete;
  sqlite_transaction& operator=(const sqlite_transaction&) = delete;
  ~sqlite_transaction() {
    if (handle_ == nullptr) return;
    try {
      handle_->run("ROLLBACK");
    } catch (const std::exception&) {
      // SQLite has rolled back by itself after some errors.
    }
  }
  void commit() {
    handle_->run("COMMIT");
    handle_ = nullptr;
  }

 private:
  sqlite_handle* handle_;
};

}  // namespace scifi::detail
