// SPDX-License-Identifier: BSD-3-Clause
#include "bench/jobs/unit_store.hpp"

#include <fmt/format.h>

#include <system_error>

#include "bench/jobs/stored_results.hpp"
#include "bench/jobs/job_id.hpp"
#include "bench/run/weak_axis_series.hpp"
#include "core/files/atomic_file.hpp"
#include "estimator/estimator_spec.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

/// What is stored of `label` under "jobs" or "specs"; empty when there is nothing.
std::string stored_text(const RunRecord& record, const char* group, const std::string& label) {
  return record.scores.value(group, Json::object()).value(label, std::string());
}

/// The spec that a label stands for: in the scenario, else in the record, else a bare name.
std::string spec_of(const Scenario& scenario, const RunRecord& record, const std::string& label) {
  for (const std::string& spec : scenario.estimators) {
    if (label_of(spec) == label) return spec;
  }
  const std::string stored = stored_text(record, "specs", label);
  return stored.empty() ? label : stored;
}

/// Drops the estimators whose id is not what it would be now, and those without a series that is
/// wanted.
void keep_current(const Scenario& scenario, std::uint64_t seed, bool series, StoredUnits& stored) {
  const RunRecord& record = *stored.record;
  Json& estimators = stored.record->scores["estimators"];
  std::vector<std::string> stale;
  std::vector<std::string> bare;
  for (const auto& [label, unused] : estimators.items()) {
    const std::string id = job_id(scenario, seed, spec_of(scenario, record, label));
    if (stored_text(record, "jobs", label) != id) {
      stale.push_back(label);
    } else if (series && !holds_series(record, label)) {
      bare.push_back(label);
    }
  }
  for (const std::string& label : bare) estimators.erase(label);
  for (const std::string& name : stale) estimators.erase(name);
  if (stale.empty()) return;
  stored.notes.push_back(fmt::format("{} seed {}: {} of another code or configuration, runs again",
                                     scenario.name, seed, fmt::join(stale, ", ")));
}

}  // namespace

UnitStore::UnitStore(const fs::path& suite_folder, bool series)
    : folder_(suite_folder / "runs"), series_(series) {}

fs::path UnitStore::folder_of(const std::string& scenario, std::uint64_t seed) const {
  return folder_ / scenario / fmt::format("seed-{}", seed);
}

StoredUnits UnitStore::find(const Scenario& scenario, std::uint64_t seed) const {
  StoredUnits stored;
  const fs::path file = folder_of(scenario.name, seed) / "scores.json";
  if (fs::exists(file)) {
    if (auto record = read_record(file)) {
      stored.record = std::move(*record);
      keep_current(scenario, seed, series_, stored);
    } else {
      stored.notes.push_back(record.error().message + "; runs again");
    }
  }
  for (const std::string& spec : scenario.estimators) {
    if (!stored.record || !stored.record->scores["estimators"].contains(label_of(spec))) {
      stored.missing.push_back(spec);
    }
  }
  return stored;
}

Result<void> UnitStore::put(const Scenario& scenario, RunRecord& record) const {
  Json ids = Json::object();
  Json specs = Json::object();
  for (const auto& [label, unused] : record.scores["estimators"].items()) {
    const std::string spec = spec_of(scenario, record, label);
    ids[label] = job_id(scenario, record.seed, spec);
    if (spec != label) specs[label] = spec;
  }
  record.scores["jobs"] = std::move(ids);
  record.scores["specs"] = std::move(specs);
  const fs::path folder = folder_of(scenario.name, record.seed);
  std::error_code code;
  fs::create_directories(folder, code);
  if (code) return failure(fmt::format("{}: {}", folder.string(), code.message()));
  return write_file_atomically(folder / "scores.json", record.scores.dump(2) + "\n");
}

}  // namespace aims
