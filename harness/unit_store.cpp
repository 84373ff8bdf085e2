// SPDX-License-Identifier: BSD-3-Clause
#include "harness/unit_store.hpp"

#include <fmt/format.h>

#include <system_error>

#include "harness/stored_results.hpp"
#include "harness/unit_id.hpp"
#include "io/atomic_file.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

/// The id under which an estimator of the record was stored; empty when it has none.
std::string stored_id(const RunRecord& record, const std::string& estimator) {
  return record.scores.value("units", Json::object()).value(estimator, std::string());
}

/// Drops the estimators whose id is not what it would be now.
void keep_current(const Scenario& scenario, std::uint64_t seed, StoredUnits& stored) {
  Json& estimators = stored.record->scores["estimators"];
  std::vector<std::string> stale;
  for (const auto& [name, unused] : estimators.items()) {
    if (stored_id(*stored.record, name) != unit_id(scenario, seed, name)) stale.push_back(name);
  }
  for (const std::string& name : stale) estimators.erase(name);
  if (stale.empty()) return;
  stored.notes.push_back(fmt::format("{} seed {}: {} of another code or configuration, runs again",
                                     scenario.name, seed, fmt::join(stale, ", ")));
}

}  // namespace

UnitStore::UnitStore(const fs::path& suite_folder) : folder_(suite_folder / "runs") {}

fs::path UnitStore::folder_of(const std::string& scenario, std::uint64_t seed) const {
  return folder_ / scenario / fmt::format("seed-{}", seed);
}

StoredUnits UnitStore::find(const Scenario& scenario, std::uint64_t seed) const {
  StoredUnits stored;
  const fs::path file = folder_of(scenario.name, seed) / "scores.json";
  if (fs::exists(file)) {
    if (auto record = read_record(file)) {
      stored.record = std::move(*record);
      keep_current(scenario, seed, stored);
    } else {
      stored.notes.push_back(record.error().message + "; runs again");
    }
  }
  for (const std::string& name : scenario.estimators) {
    if (!stored.record || !stored.record->scores["estimators"].contains(name)) {
      stored.missing.push_back(name);
    }
  }
  return stored;
}

Result<void> UnitStore::put(const Scenario& scenario, RunRecord& record) const {
  Json ids = Json::object();
  for (const auto& [name, unused] : record.scores["estimators"].items()) {
    ids[name] = unit_id(scenario, record.seed, name);
  }
  record.scores["units"] = std::move(ids);
  const fs::path folder = folder_of(scenario.name, record.seed);
  std::error_code code;
  fs::create_directories(folder, code);
  if (code) return failure(fmt::format("{}: {}", folder.string(), code.message()));
  return write_file_atomically(folder / "scores.json", record.scores.dump(2) + "\n");
}

}  // namespace aims
