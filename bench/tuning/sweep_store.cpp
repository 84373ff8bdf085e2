// SPDX-License-Identifier: BSD-3-Clause
#include "bench/tuning/sweep_store.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>
#include <unistd.h>

#include <charconv>
#include <optional>
#include <system_error>

#include "bench/scoring/json_text.hpp"

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

void bind_text(SQLite::Statement& statement, int at, const Json& file, const char* key) {
  const auto found = file.is_object() ? file.find(key) : file.end();
  if (found != file.end() && found->is_string()) {
    statement.bind(at, found->get<std::string>());
  } else {
    statement.bind(at);
  }
}

void bind_number(SQLite::Statement& statement, int at, const Json& value) {
  if (value.is_number()) {
    statement.bind(at, value.get<double>());
  } else if (value.is_boolean()) {
    statement.bind(at, value.get<bool>() ? 1 : 0);
  } else if (value.is_string()) {
    statement.bind(at, value.get<std::string>());
  } else {
    statement.bind(at);
  }
}

/// A setting's text as the number that it is, if it is one.
Json setting_value(const std::string& text) {
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error == std::errc() && end == text.data() + text.size()) return number;
  return text;
}

/// Fills the tables of an empty database.
class Filler {
 public:
  explicit Filler(SQLite::Database& database)
      : job_(database, "INSERT INTO jobs VALUES (?,?,?,?,?,?,?,?,?,?,?,?)"),
        parameter_(database, "INSERT INTO parameters VALUES (?,?,?)"),
        score_(database, "INSERT INTO scores VALUES (?,?,?)"),
        about_(database, "INSERT INTO about VALUES (?,?)") {}

  void about(const std::string& key, const std::string& value) {
    about_.bind(1, key);
    about_.bind(2, value);
    finish(about_);
  }

  void add(const MergedJob& job) {
    ++number_;
    const ListedJob& listed = job.listed;
    const Json& file = job.file;
    job_.bind(1, number_);
    job_.bind(2, listed.id);
    job_.bind(3, listed.scenario);
    bind_text(job_, 4, file, "family");
    bind_number(job_, 5, value_in(file, "level", Json()));
    job_.bind(6, static_cast<std::int64_t>(seed_of(listed)));
    const std::size_t plus = listed.estimator.find('+');
    job_.bind(7, listed.estimator.substr(0, plus));
    job_.bind(8, plus == std::string::npos ? "" : listed.estimator.substr(plus + 1));
    job_.bind(9, job.outcome());
    bind_text(job_, 10, file, "message");
    const auto invalid = job.invalid();
    if (invalid) job_.bind(10, *invalid);
    bind_text(job_, 11, file, "code");
    bind_number(job_, 12, value_in(file, "wall_s", Json()));
    finish(job_);
    if (!file.is_object()) return;
    const Json settings = value_in(file, "settings", Json::object());
    for (const auto& [key, value] : settings.items()) {
      if (value.is_string()) add_value(parameter_, key, setting_value(value.get<std::string>()));
    }
    if (job.invalid()) return;
    const Json scores = value_in(file, "scores", Json());
    visit_leaves(scores, "", [this](const std::string& key, const Json& value) {
      add_value(score_, key, value);
    });
  }

 private:
  void add_value(SQLite::Statement& statement, const std::string& key, const Json& value) {
    statement.bind(1, number_);
    statement.bind(2, key);
    bind_number(statement, 3, value);
    finish(statement);
  }

  static void finish(SQLite::Statement& statement) {
    statement.exec();
    statement.reset();
  }

  std::int64_t number_ = 0;
  SQLite::Statement job_;
  SQLite::Statement parameter_;
  SQLite::Statement score_;
  SQLite::Statement about_;
};

void fill(const MergedSweep& sweep, const fs::path& file) {
  // Nobody else knows the file yet: no locks, which some network disks lack, and no journal.
  SQLite::Database database(file.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE, 0,
                            "unix-none");
  database.exec("PRAGMA journal_mode=OFF; PRAGMA synchronous=OFF;");
  database.exec(kTables);
  SQLite::Transaction transaction(database);
  Filler filler(database);
  filler.about("schema", std::string(kSweepSchema));
  for (const std::string& plan : sweep.plans) filler.about("plan", plan);
  for (const MergedJob& job : sweep.jobs) filler.add(job);
  transaction.commit();
}

}  // namespace

Result<void> write_sqlite(const MergedSweep& sweep, const fs::path& file) {
  const fs::path temporary = fmt::format("{}.{}.tmp", file.string(), ::getpid());
  std::error_code code;
  fs::remove(temporary, code);
  try {
    fill(sweep, temporary);
    fs::rename(temporary, file);
    return {};
  } catch (const std::exception& error) {
    fs::remove(temporary, code);
    return failure(fmt::format("{}: cannot be written: {}", file.string(), error.what()));
  }
}

}  // namespace aims
