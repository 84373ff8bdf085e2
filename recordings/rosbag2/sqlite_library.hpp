// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "core/error.hpp"

struct sqlite3;
struct sqlite3_stmt;

namespace aims {

/// The functions of SQLite that recordings use, with the types of sqlite3.h.
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
  int (*bind_text)(sqlite3_stmt*, int, const char*, int, void (*)(void*)) = nullptr;
  int (*bind_blob)(sqlite3_stmt*, int, const void*, int, void (*)(void*)) = nullptr;
  int (*column_count)(sqlite3_stmt*) = nullptr;
  int (*column_type)(sqlite3_stmt*, int) = nullptr;
  long long (*column_integer)(sqlite3_stmt*, int) = nullptr;
  const void* (*column_blob)(sqlite3_stmt*, int) = nullptr;
  int (*column_bytes)(sqlite3_stmt*, int) = nullptr;
  const char* (*message)(sqlite3*) = nullptr;
};

/// The system's SQLite, loaded when the first database is opened: programs that read no database
/// need not have it. Error when it is not installed.
Result<std::shared_ptr<const SqliteFunctions>> load_sqlite();

}  // namespace aims
