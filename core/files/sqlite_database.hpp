// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "core/error.hpp"

struct sqlite3;
struct sqlite3_stmt;

namespace aims {

/// The functions of SQLite that are used, with the types of sqlite3.h.
struct SqliteFunctions {
  int (*open)(const char*, sqlite3**, int, const char*) = nullptr;
  int (*close)(sqlite3*) = nullptr;
  int (*config)(sqlite3*, int, ...) = nullptr;
  int (*limit)(sqlite3*, int, int) = nullptr;
  int (*run)(sqlite3*, const char*, int (*)(void*, int, char**, char**), void*, char**) = nullptr;
  int (*prepare)(sqlite3*, const char*, int, sqlite3_stmt**, const char**) = nullptr;
  int (*finalize)(sqlite3_stmt*) = nullptr;
  int (*step)(sqlite3_stmt*) = nullptr;
  int (*reset)(sqlite3_stmt*) = nullptr;
  int (*bind_integer)(sqlite3_stmt*, int, long long) = nullptr;
  int (*bind_number)(sqlite3_stmt*, int, double) = nullptr;
  int (*bind_null)(sqlite3_stmt*, int) = nullptr;
  int (*bind_text)(sqlite3_stmt*, int, const char*, int, void (*)(void*)) = nullptr;
  int (*bind_blob)(sqlite3_stmt*, int, const void*, int, void (*)(void*)) = nullptr;
  int (*column_count)(sqlite3_stmt*) = nullptr;
  int (*column_type)(sqlite3_stmt*, int) = nullptr;
  long long (*column_integer)(sqlite3_stmt*, int) = nullptr;
  const void* (*column_blob)(sqlite3_stmt*, int) = nullptr;
  int (*column_bytes)(sqlite3_stmt*, int) = nullptr;
  const char* (*message)(sqlite3*) = nullptr;
};

/// The system's SQLite, loaded when the first database is opened: programs that open no database
/// need not have it. Error when it is not installed.
Result<std::shared_ptr<const SqliteFunctions>> load_sqlite();

class SqliteDatabase;

/// A prepared statement; it must not outlive its database. Columns are counted from 0, parameters
/// from 1.
class SqliteStatement {
 public:
  SqliteStatement(SqliteStatement&&) noexcept;
  SqliteStatement& operator=(SqliteStatement&&) noexcept;
  ~SqliteStatement();

  SqliteStatement& bind(int parameter, std::int64_t value);
  SqliteStatement& bind_number(int parameter, double value);
  SqliteStatement& bind_null(int parameter);
  /// The bytes must stay until the statement has run.
  SqliteStatement& bind(int parameter, std::string_view text);
  SqliteStatement& bind(int parameter, std::span<const std::byte> bytes);

  /// Runs to the next row; false behind the last one.
  Result<bool> step();
  /// Runs to the end and makes the statement ready for the next run.
  Result<void> finish();
  void reset();

  int columns() const;
  bool is_integer(int column) const;
  std::int64_t integer(int column) const;
  /// Of a text or a blob, valid until the next step or reset.
  std::span<const std::byte> bytes(int column) const;
  std::string text(int column) const;

 private:
  friend class SqliteDatabase;
  SqliteStatement(const SqliteDatabase& database, sqlite3_stmt* statement);
  const SqliteFunctions* functions_;
  std::string name_;
  sqlite3* database_;
  sqlite3_stmt* statement_;
  int bound_;
};

/// A database file. Errors are "FILE: SQLite: WHAT".
class SqliteDatabase {
 public:
  /// For reading alone. No value may be longer than `max_value` bytes, and nothing that the schema
  /// of a foreign file defines runs: no views, triggers or functions with effects.
  static Result<SqliteDatabase> open(const std::filesystem::path& file, std::size_t max_value);
  /// A new file; error when it exists. Without locks, which some network disks lack, only where
  /// nobody else knows it.
  static Result<SqliteDatabase> create(const std::filesystem::path& file, bool with_locks = true);
  SqliteDatabase(SqliteDatabase&&) noexcept;
  SqliteDatabase& operator=(SqliteDatabase&&) noexcept;
  ~SqliteDatabase();

  const std::filesystem::path& file() const { return file_; }
  Result<SqliteStatement> prepare(const std::string& sql) const;
  /// Runs statements that return nothing.
  Result<void> run(const std::string& sql) const;

 private:
  friend class SqliteStatement;
  SqliteDatabase(std::shared_ptr<const SqliteFunctions> functions, std::filesystem::path file,
                 sqlite3* database);
  static Result<SqliteDatabase> open_as(const std::filesystem::path& file, const std::string& uri,
                                        int flags);
  void harden(std::size_t max_value) const;

  std::shared_ptr<const SqliteFunctions> functions_;
  std::filesystem::path file_;
  sqlite3* database_;
};

}  // namespace aims
