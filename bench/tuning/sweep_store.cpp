// SPDX-License-Identifier: BSD-3-Clause
#include "bench/tuning/sweep_store.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <system_error>

#include "bench/scoring/json_text.hpp"
#include "core/files/sqlite_database.hpp"
#include "core/text.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

constexpr const char* kTables = R"(
CREATE TABLE about (key TEXT NOT NULL, value TEXT NOT NULL);
CREATE TABLE jobs (job INTEGER PRIMARY KEY, id TEXT NOT NULL UNIQUE, scenario TEXT NOT NULL,
  family TEXT, level REAL, seed INTEGER NOT NULL, estimator TEXT NOT NULL, settings TEXT NOT NULL,
  outcome TEXT NOT NULL, message TEXT, code TEXT, wall_s REAL);
CREATE TABLE parameters (job INTEGER NOT NULL REFERENCES jobs, key TEXT NOT NULL, value,
  PRIMARY KEY (job, key)) WITHOUT ROWID;
CREATE TABLE scores (job INTEGER NOT NULL REFERENCES jobs, key TEXT NOT NULL, value,
  PRIMARY KEY (job, key)) WITHOUT ROWID;
)";

/// A number, a truth value as 0 or 1, or a text, which must stay until the statement has run; else
/// null.
void bind(SqliteStatement& statement, int at, const Json& value) {
  if (value.is_number()) {
    statement.bind_number(at, value.get<double>());
  } else if (value.is_boolean()) {
    statement.bind(at, std::int64_t{value.get<bool>()});
  } else if (value.is_string()) {
    statement.bind(at, value.get_ref<const std::string&>());
  } else {
    statement.bind_null(at);
  }
}

/// A setting's text as the number that it is, if it is one.
Json setting_value(const std::string& text) {
  const auto number = number_from<double>(text);
  return number ? Json(*number) : Json(text);
}

/// Fills the tables of an empty database.
class Filler {
 public:
  explicit Filler(const SqliteDatabase& database)
      : job_(database.prepare("INSERT INTO jobs VALUES (?,?,?,?,?,?,?,?,?,?,?,?)")),
        parameter_(database.prepare("INSERT INTO parameters VALUES (?,?,?)")),
        score_(database.prepare("INSERT INTO scores VALUES (?,?,?)")),
        about_(database.prepare("INSERT INTO about VALUES (?,?)")) {
    for (const auto* each : {&job_, &parameter_, &score_, &about_}) {
      if (done_ && !*each) done_ = tl::unexpected(each->error());
    }
  }

  void about(std::string_view key, std::string_view value) {
    if (done_) done_ = about_->bind(1, key).bind(2, value).finish();
  }

  void add(const MergedJob& job) {
    if (!done_) return;
    ++number_;
    const ListedJob& listed = job.listed;
    const Json& file = job.file;
    const std::string_view estimator = listed.estimator;
    const std::size_t plus = std::min(estimator.find('+'), estimator.size());
    const std::string outcome = job.outcome();
    const auto invalid = job.invalid();
    job_->bind(1, number_).bind(2, listed.id).bind(3, listed.scenario);
    bind(*job_, 4, member(file, "family"));
    bind(*job_, 5, member(file, "level"));
    job_->bind(6, static_cast<std::int64_t>(seed_of(listed)));
    job_->bind(7, estimator.substr(0, plus));
    job_->bind(8, estimator.substr(std::min(plus + 1, estimator.size())));
    job_->bind(9, outcome);
    bind(*job_, 10, member(file, "message"));
    if (invalid) job_->bind(10, *invalid);
    bind(*job_, 11, member(file, "code"));
    bind(*job_, 12, member(file, "wall_s"));
    done_ = job_->finish();
    if (!file.is_object()) return;
    const Json settings = value_in(file, "settings", Json::object());
    for (const auto& [key, value] : settings.items()) {
      if (value.is_string()) add_value(*parameter_, key, setting_value(value.get<std::string>()));
    }
    if (invalid) return;
    visit_leaves(member(file, "scores"), "", [this](const std::string& key, const Json& value) {
      add_value(*score_, key, value);
    });
  }

  /// The first error.
  const Result<void>& done() const { return done_; }

 private:
  void add_value(SqliteStatement& statement, const std::string& key, const Json& value) {
    if (!done_) return;
    statement.bind(1, number_).bind(2, key);
    bind(statement, 3, value);
    done_ = statement.finish();
  }

  std::int64_t number_ = 0;
  Result<void> done_;
  Result<SqliteStatement> job_;
  Result<SqliteStatement> parameter_;
  Result<SqliteStatement> score_;
  Result<SqliteStatement> about_;
};

Result<void> fill(const MergedSweep& sweep, const fs::path& file) {
  const auto database = SqliteDatabase::create(file, false);
  if (!database) return tl::unexpected(database.error());
  const std::string begin =
      std::string("PRAGMA journal_mode=OFF; PRAGMA synchronous=OFF;") + kTables;
  if (auto begun = database->run(begin + "BEGIN;"); !begun) return begun;
  Filler filler(*database);
  filler.about("schema", kSweepSchema);
  for (const std::string& plan : sweep.plans) filler.about("plan", plan);
  for (const MergedJob& job : sweep.jobs) filler.add(job);
  return filler.done() ? database->run("COMMIT;") : filler.done();
}

}  // namespace

Result<void> write_sqlite(const MergedSweep& sweep, const fs::path& file) {
  const fs::path temporary = fmt::format("{}.{}.tmp", file.string(), ::getpid());
  std::error_code code;
  fs::remove(temporary, code);
  auto written = fill(sweep, temporary);
  if (written) {
    fs::rename(temporary, file, code);
    if (!code) return {};
    written = failure(code.message());
  }
  fs::remove(temporary, code);
  return failure(fmt::format("{}: cannot be written: {}", file.string(), written.error().message));
}

}  // namespace aims
