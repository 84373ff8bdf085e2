// SPDX-License-Identifier: BSD-3-Clause
#include "bench/jobs/stored_results.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <utility>

#include "bench/jobs/job_store.hpp"
#include "bench/scoring/json_text.hpp"
#include "bench/scoring/result_files.hpp"
#include "bench/scoring/validity.hpp"

namespace aims {

namespace {

namespace fs = std::filesystem;

/// What the jobs of one scenario and seed came to.
struct StoredRun {
  std::vector<LabelledResult> results;
  std::map<std::string, std::string> specs;
  bool complete = true;
};

/// The jobs of a store that have ended, by scenario and seed.
Result<StoredResults> read_store(const JobStore& store) {
  const auto listed = store.listed();
  if (!listed) return tl::unexpected(listed.error());
  std::map<std::pair<std::string, std::uint64_t>, StoredRun> runs;
  for (const ListedJob& job : *listed) {
    auto result = store.find(job.id);
    StoredRun& run = runs[{job.scenario, seed_of(job)}];
    run.complete = run.complete && result;
    if (!result) continue;
    // Points of a sweep share a label.
    const bool repeated = std::ranges::any_of(
        run.results, [&](const LabelledResult& each) { return each.label == job.label; });
    const std::string& label = repeated ? job.estimator : job.label;
    run.specs[label] = job.estimator;
    run.results.push_back({label, std::move(*result)});
  }
  StoredResults results;
  for (const auto& [key, run] : runs) {
    RunRecord record = record_of(key.first, key.second, run.results, run.complete);
    record.specs = run.specs;
    if (has_outcome(record)) results[key.first].push_back(std::move(record));
  }
  return results;
}

}  // namespace

RunRecord record_of(const std::string& scenario, std::uint64_t seed,
                    std::span<const LabelledResult> results, bool complete) {
  RunRecord record;
  record.seed = seed;
  record.scores = {{"schema", kScoresSchema}, {"version", AIMS_VERSION},
                   {"scenario", scenario},    {"seed", seed},
                   {"complete", complete},    {"failures", Json::array()}};
  Json estimators = Json::object();
  Json times = Json::object();
  for (const auto& [label, result] : results) {
    if (result.outcome == JobOutcome::kNotSimulated) continue;
    if (result.outcome != JobOutcome::kDone) {
      record.scores["failures"].push_back({{"estimator", label}, {"message", result.message}});
      continue;
    }
    for (const auto& [key, value] : result.sequence.items()) {
      if (!record.scores.contains(key)) record.scores[key] = value;
    }
    estimators[label] = result.scores;
    times[label] = result.wall_s;
  }
  record.scores["wall_s"] = std::move(times);
  record.scores["estimators"] = std::move(estimators);
  mark_validity(record.scores);
  return record;
}

Result<StoredResults> read_results(const fs::path& folder) {
  StoredResults results;
  if (fs::exists(folder / "jobs.csv")) {
    auto stored = read_store(JobStore(folder));
    if (!stored) return stored;
    results = std::move(*stored);
  } else if (fs::exists(folder / "scores.json")) {
    auto record = read_record(folder / "scores.json");
    if (!record) return tl::unexpected(record.error());
    results[value_in(record->scores, "scenario", "")].push_back(std::move(*record));
  }
  if (!results.empty()) return results;
  return failure(fmt::format("{}: holds no finished results", folder.string()));
}

}  // namespace aims
