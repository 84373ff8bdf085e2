// SPDX-License-Identifier: BSD-3-Clause
#include "core/files/sqlite_database.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <sqlite3.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <system_error>
#include <type_traits>
#include <utility>

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
  symbols.find("sqlite3_bind_double", functions.bind_number);
  symbols.find("sqlite3_bind_null", functions.bind_null);
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
    return failure(std::string("SQLite databases need the library ") + kLibrary +
                   " (Debian package libsqlite3-0), which is not installed");
  }
  auto functions = std::make_shared<SqliteFunctions>();
  const bool complete = find_all(library, *functions);
  ::dlclose(library);
  if (!complete) return failure(std::string(kLibrary) + ": expected SQLite 3.29 or later");
  return functions;
}

namespace {

namespace fs = std::filesystem;

/// For bound bytes that the caller keeps: SQLITE_STATIC.
constexpr void (*kKeptByCaller)(void*) = nullptr;

tl::unexpected<Error> sqlite_failure(const std::string& file, const SqliteFunctions& functions,
                                     sqlite3* database) {
  return failure(fmt::format("{}: SQLite: {}", file, functions.message(database)));
}

/// A URI of the file with that query.
std::string uri_of(const fs::path& file, std::string_view query) {
  std::string uri = "file:";
  for (const char c : fs::absolute(file).string()) {
    const bool plain = c > ' ' && c < 0x7f && c != '%' && c != '?' && c != '#';
    uri += plain ? std::string(1, c) : fmt::format("%{:02x}", static_cast<unsigned char>(c));
  }
  return uri.append(query);
}

/// Whether the file was left in write-ahead mode, where even a reader would create files beside it.
bool has_write_ahead_mode(const fs::path& file) {
  std::string header(20, '\0');
  std::ifstream(file, std::ios::binary).read(header.data(), 20);
  return header[18] == 2 || header[19] == 2;
}

bool has_log_beside(const fs::path& file) {
  std::error_code code;
  const auto size = fs::file_size(fs::path(file) += "-wal", code);
  return !code && size > 0;
}

}  // namespace

SqliteDatabase::SqliteDatabase(std::shared_ptr<const SqliteFunctions> functions, fs::path file,
                               sqlite3* database)
    : functions_(std::move(functions)), file_(std::move(file)), database_(database) {}

SqliteDatabase::SqliteDatabase(SqliteDatabase&& other) noexcept
    : functions_(other.functions_),
      file_(std::move(other.file_)),
      database_(std::exchange(other.database_, nullptr)) {}

SqliteDatabase& SqliteDatabase::operator=(SqliteDatabase&& other) noexcept {
  std::swap(functions_, other.functions_);
  std::swap(file_, other.file_);
  std::swap(database_, other.database_);
  return *this;
}

SqliteDatabase::~SqliteDatabase() { functions_->close(database_); }

Result<SqliteDatabase> SqliteDatabase::open_as(const fs::path& file, const std::string& uri,
                                               int flags) {
  auto functions = load_sqlite();
  if (!functions) {
    return failure(fmt::format("{}: {}", file.string(), functions.error().message));
  }
  sqlite3* opened = nullptr;
  const int code = (*functions)->open(uri.c_str(), &opened, flags | SQLITE_OPEN_URI, nullptr);
  SqliteDatabase database(*functions, file, opened);
  if (code != SQLITE_OK) return sqlite_failure(file.string(), **functions, opened);
  return database;
}

void SqliteDatabase::harden(std::size_t max_value) const {
  const auto bound = std::min<std::size_t>(max_value, std::numeric_limits<int>::max());
  // Shorter would refuse the statements themselves.
  functions_->limit(database_, SQLITE_LIMIT_LENGTH, std::max(1 << 16, static_cast<int>(bound)));
  functions_->limit(database_, SQLITE_LIMIT_WORKER_THREADS, 0);
  functions_->config(database_, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  functions_->config(database_, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
  functions_->config(database_, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
  functions_->config(database_, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
}

Result<SqliteDatabase> SqliteDatabase::open(const fs::path& file, std::size_t max_value) {
  const bool immutable = has_write_ahead_mode(file) && !has_log_beside(file);
  // Immutable: read without locks, and without files beside it.
  auto database =
      open_as(file, uri_of(file, immutable ? "?immutable=1" : ""), SQLITE_OPEN_READONLY);
  if (database) database->harden(max_value);
  return database;
}

Result<SqliteDatabase> SqliteDatabase::create(const fs::path& file, bool with_locks) {
  std::error_code code;
  if (fs::exists(fs::symlink_status(file, code))) {
    return failure(fmt::format("{}: cannot be created: File exists", file.string()));
  }
  return open_as(file, uri_of(file, with_locks ? "" : "?vfs=unix-none"),
                 SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE);
}

Result<SqliteStatement> SqliteDatabase::prepare(const std::string& sql) const {
  sqlite3_stmt* statement = nullptr;
  const int code = functions_->prepare(database_, sql.c_str(), -1, &statement, nullptr);
  if (code != SQLITE_OK) return sqlite_failure(file_.string(), *functions_, database_);
  return SqliteStatement(*this, statement);
}

Result<void> SqliteDatabase::run(const std::string& sql) const {
  const int code = functions_->run(database_, sql.c_str(), nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) return sqlite_failure(file_.string(), *functions_, database_);
  return {};
}

SqliteStatement::SqliteStatement(const SqliteDatabase& database, sqlite3_stmt* statement)
    : functions_(database.functions_.get()),
      name_(database.file_.string()),
      database_(database.database_),
      statement_(statement),
      bound_(SQLITE_OK) {}

SqliteStatement::SqliteStatement(SqliteStatement&& other) noexcept
    : functions_(other.functions_),
      name_(std::move(other.name_)),
      database_(other.database_),
      statement_(std::exchange(other.statement_, nullptr)),
      bound_(other.bound_) {}

SqliteStatement& SqliteStatement::operator=(SqliteStatement&& other) noexcept {
  std::swap(functions_, other.functions_);
  std::swap(name_, other.name_);
  std::swap(database_, other.database_);
  std::swap(statement_, other.statement_);
  std::swap(bound_, other.bound_);
  return *this;
}

SqliteStatement::~SqliteStatement() { functions_->finalize(statement_); }

SqliteStatement& SqliteStatement::bind(int parameter, std::int64_t value) {
  bound_ |= functions_->bind_integer(statement_, parameter, value);
  return *this;
}

SqliteStatement& SqliteStatement::bind_number(int parameter, double value) {
  bound_ |= functions_->bind_number(statement_, parameter, value);
  return *this;
}

SqliteStatement& SqliteStatement::bind_null(int parameter) {
  bound_ |= functions_->bind_null(statement_, parameter);
  return *this;
}

SqliteStatement& SqliteStatement::bind(int parameter, std::string_view text) {
  bound_ |= functions_->bind_text(statement_, parameter, text.data(), static_cast<int>(text.size()),
                                  kKeptByCaller);
  return *this;
}

SqliteStatement& SqliteStatement::bind(int parameter, std::span<const std::byte> bytes) {
  // Without an address SQLite would store NULL.
  const void* data = bytes.empty() ? static_cast<const void*>("") : bytes.data();
  bound_ |= functions_->bind_blob(statement_, parameter, data, static_cast<int>(bytes.size()),
                                  kKeptByCaller);
  return *this;
}

Result<bool> SqliteStatement::step() {
  const int code = bound_ != SQLITE_OK ? bound_ : functions_->step(statement_);
  if (code == SQLITE_ROW) return true;
  if (code == SQLITE_DONE) return false;
  return sqlite_failure(name_, *functions_, database_);
}

Result<void> SqliteStatement::finish() {
  auto row = step();
  while (row && *row) row = step();
  reset();
  if (!row) return tl::unexpected(row.error());
  return {};
}

void SqliteStatement::reset() {
  functions_->reset(statement_);
  bound_ = SQLITE_OK;
}

int SqliteStatement::columns() const { return functions_->column_count(statement_); }

bool SqliteStatement::is_integer(int column) const {
  return functions_->column_type(statement_, column) == SQLITE_INTEGER;
}

std::int64_t SqliteStatement::integer(int column) const {
  return functions_->column_integer(statement_, column);
}

std::span<const std::byte> SqliteStatement::bytes(int column) const {
  const void* data = functions_->column_blob(statement_, column);
  const int size = functions_->column_bytes(statement_, column);
  if (data == nullptr || size <= 0) return {};
  return {static_cast<const std::byte*>(data), static_cast<std::size_t>(size)};
}

std::string SqliteStatement::text(int column) const {
  const auto found = bytes(column);
  return {reinterpret_cast<const char*>(found.data()), found.size()};
}

}  // namespace aims
