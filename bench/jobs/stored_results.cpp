// SPDX-License-Identifier: BSD-3-Clause
#include "bench/jobs/stored_results.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "bench/jobs/unit_store.hpp"
#include "bench/studies/suite.hpp"
#include "core/files/atomic_file.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

Result<Json> read_json(const fs::path& file) {
  const auto text = read_file(file);
  if (!text) return tl::unexpected(text.error());
  Json json = Json::parse(*text, nullptr, false);
  if (json.is_discarded()) return failure(fmt::format("{}: is not whole JSON", file.string()));
  return json;
}

/// Files of an `aims run`: of one seed, or of several.
std::vector<fs::path> run_files(const fs::path& folder) {
  if (fs::exists(folder / "scores.json")) return {folder / "scores.json"};
  std::vector<fs::path> files;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    const bool is_seed = entry.path().filename().string().starts_with("seed-");
    if (is_seed && fs::exists(entry.path() / "scores.json")) {
      files.push_back(entry.path() / "scores.json");
    }
  }
  return files;
}

/// The record without the estimators that are not in the list.
void keep_only(const Json& names, RunRecord& record) {
  Json kept = Json::object();
  for (const auto& [name, scores] : record.scores["estimators"].items()) {
    if (std::find(names.begin(), names.end(), name) != names.end()) kept[name] = scores;
  }
  record.scores["estimators"] = std::move(kept);
}

Result<StoredResults> read_suite(const fs::path& folder) {
  const auto suite = read_json(folder / "suite.json");
  if (!suite) return tl::unexpected(suite.error());
  if (suite->value("schema", "") != kSuiteSchema) {
    return failure(
        fmt::format("{}: schema is not {}", (folder / "suite.json").string(), kSuiteSchema));
  }
  const UnitStore store(folder);
  StoredResults results;
  for (const Json& scenario : suite->value("scenarios", Json::array())) {
    const auto name = scenario.at("name").get<std::string>();
    Json estimators = Json::array();
    for (const auto& [estimator, unused] : scenario.at("estimators").items()) {
      estimators.push_back(estimator);
    }
    for (const Json& seed : scenario.at("seeds")) {
      auto record = read_record(store.folder_of(name, seed.get<std::uint64_t>()) / "scores.json");
      if (!record) return tl::unexpected(record.error());
      keep_only(estimators, *record);
      results[name].push_back(std::move(*record));
    }
  }
  return results;
}

}  // namespace

Result<RunRecord> read_record(const fs::path& file) {
  auto json = read_json(file);
  if (!json) return tl::unexpected(json.error());
  const bool known = json->is_object() && json->value("schema", "") == kScoresSchema &&
                     json->contains("seed") && (*json)["seed"].is_number_unsigned() &&
                     json->contains("estimators") && (*json)["estimators"].is_object();
  if (!known) return failure(fmt::format("{}: holds no {}", file.string(), kScoresSchema));
  return RunRecord{(*json)["seed"].get<std::uint64_t>(), std::move(*json)};
}

Result<StoredResults> read_results(const fs::path& folder) {
  StoredResults results;
  if (fs::exists(folder / "suite.json")) {
    auto suite = read_suite(folder);
    if (!suite) return suite;
    results = std::move(*suite);
  }
  for (const fs::path& file : run_files(folder)) {
    auto record = read_record(file);
    if (!record) return tl::unexpected(record.error());
    if (!record->scores.value("complete", false)) continue;
    results[record->scores.value("scenario", "")].push_back(std::move(*record));
  }
  for (auto& [scenario, runs] : results) {
    std::sort(runs.begin(), runs.end(),
              [](const RunRecord& a, const RunRecord& b) { return a.seed < b.seed; });
  }
  if (!results.empty()) return results;
  return failure(
      fmt::format("{}: holds no finished results of aims run or aims suite", folder.string()));
}

}  // namespace aims
