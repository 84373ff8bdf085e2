// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/rosbag2/sqlite_library.hpp"

#include <dlfcn.h>
#include <sqlite3.h>

#include <type_traits>

namespace aims {
namespace {

constexpr const char* kLibrary = "libsqlite3.so.0";

/// The types in `SqliteFunctions` are those of the header.
static_assert(std::is_same_v<decltype(SqliteFunctions::open), decltype(&sqlite3_open_v2)>);
static_assert(std::is_same_v<decltype(SqliteFunctions::close), decltype(&sqlite3_close_v2)>);
static_assert(std::is_same_v<decltype(SqliteFunctions::config), decltype(&sqlite3_db_config)>);
static_assert(std::is_same_v<decltype(SqliteFunctions::run), decltype(&sqlite3_exec)>);
static_assert(std::is_same_v<decltype(SqliteFunctions::prepare), decltype(&sqlite3_prepare_v2)>);
static_assert(std::is_same_v<decltype(SqliteFunctions::bind_text), decltype(&sqlite3_bind_text)>);
static_assert(std::is_same_v<decltype(SqliteFunctions::bind_blob), decltype(&sqlite3_bind_blob)>);

/// Finds functions by name, until one is missing.
class Symbols {
 public:
  explicit Symbols(void* library) : library_(library) {}

  template <class Function>
  void find(const char* name, Function& function) {
    function = reinterpret_cast<Function>(::dlsym(library_, name));
    complete_ = complete_ && function != nullptr;
  }

  bool complete() const { return complete_; }

 private:
  void* library_;
  bool complete_ = true;
};

bool find_all(void* library, SqliteFunctions& functions) {
  Symbols symbols(library);
  symbols.find("sqlite3_open_v2", functions.open);
  symbols.find("sqlite3_close_v2", functions.close);
  symbols.find("sqlite3_db_config", functions.config);
  symbols.find("sqlite3_limit", functions.limit);
  symbols.find("sqlite3_exec", functions.run);
  symbols.find("sqlite3_prepare_v2", functions.prepare);
  symbols.find("sqlite3_finalize", functions.finalize);
  symbols.find("sqlite3_step", functions.step);
  symbols.find("sqlite3_reset", functions.reset);
  symbols.find("sqlite3_bind_int64", functions.bind_integer);
  symbols.find("sqlite3_bind_text", functions.bind_text);
  symbols.find("sqlite3_bind_blob", functions.bind_blob);
  symbols.find("sqlite3_column_count", functions.column_count);
  symbols.find("sqlite3_column_type", functions.column_type);
  symbols.find("sqlite3_column_int64", functions.column_integer);
  symbols.find("sqlite3_column_blob", functions.column_blob);
  symbols.find("sqlite3_column_bytes", functions.column_bytes);
  symbols.find("sqlite3_errmsg", functions.message);
  return symbols.complete();
}

}  // namespace

Result<std::shared_ptr<const SqliteFunctions>> load_sqlite() {
  // It stays loaded: SQLite keeps locks of the process in its own memory.
  void* library = ::dlopen(kLibrary, RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
  if (library == nullptr) {
    return failure(std::string("reading and writing .db3 needs SQLite (") + kLibrary +
                   "; Debian package libsqlite3-0), which is not installed");
  }
  auto functions = std::make_shared<SqliteFunctions>();
  const bool complete = find_all(library, *functions);
  ::dlclose(library);
  if (!complete) return failure(std::string(kLibrary) + ": expected SQLite 3.29 or later");
  return functions;
}

}  // namespace aims
