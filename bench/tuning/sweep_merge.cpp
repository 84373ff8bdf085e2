// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include "bench/scoring/report.hpp"
#include "bench/scoring/validity.hpp"
#include "bench/tuning/sweep_plan.hpp"
#include "bench/tuning/sweep_store.hpp"
#include "core/files/csv.hpp"
#include "core/files/yaml_config.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMissing = "missing";
constexpr const char* kInvalid = "invalid";

/// The file of a job; null when it is not there or no such file.
Json file_of(const JobStore& folder, const std::string& id) {
  auto json = folder.read(id);
  return json && result_in(*json) ? std::move(*json) : Json();
}

/// Names in the order in which they first come, each once.
class Columns {
 public:
  void add(const std::string& name) {
    if (known_.insert(name).second) names_.push_back(name);
  }
  const std::vector<std::string>& names() const { return names_; }

 private:
  std::set<std::string> known_;
  std::vector<std::string> names_;
};

/// What makes the jobs of a folder those of one sweep.
struct FolderPlan {
  fs::path file;
  std::string code;
  SweepPlan plan;
};

Result<FolderPlan> folder_plan(const JobStore& folder, const std::string& text) {
  FolderPlan result{folder.path() / "plan.yaml", folder.code().value_or(""), {}};
  const auto read = load_config_text(text, result.file, result.plan);
  if (!read) return tl::unexpected(read.error());
  return result;
}

/// "params: [a=0:1:3] and [b=0:1:3]" of each of these keys that differs.
std::vector<std::string> differences(FolderPlan& a, FolderPlan& b,
                                     std::span<const char* const> keys) {
  const Fields of_a = fields_of(a.plan);
  const Fields of_b = fields_of(b.plan);
  std::vector<std::string> texts;
  for (const char* key : keys) {
    const std::string left = of_a.find(key)->text();
    const std::string right = of_b.find(key)->text();
    if (left != right) texts.push_back(fmt::format("{}: {} and {}", key, left, right));
  }
  return texts;
}

/// Error where the points of two folders would not be on the same sequences: all else must be
/// alike where one of the free keys differs.
Result<void> check_plans(FolderPlan a, FolderPlan b) {
  constexpr std::array kFixed = {"params", "set", "design", "samples", "design_seed"};
  constexpr std::array kFree = {"seeds", "scenarios", "tags", "estimators"};
  std::vector<std::string> found = differences(a, b, kFixed);
  if (a.code != b.code) found.push_back(fmt::format("code: {} and {}", a.code, b.code));
  const std::vector<std::string> free = differences(a, b, kFree);
  if (found.empty() && free.size() < 2) return {};
  found.insert(found.end(), free.begin(), free.end());
  return failure(fmt::format(
      "{} and {} are different plans ({}); expected folders of one plan, or of plans that differ "
      "in seeds, scenarios, tags or estimators alone; nothing was written, merge each on its own",
      a.file.string(), b.file.string(), fmt::join(found, "; ")));
}

/// Which version of a scenario and an estimator at a point was run, and in which folder.
class Versions {
 public:
  /// Error where an earlier folder has another version of the same.
  Result<void> add(const fs::path& folder, const ListedJob& job) {
    if (job.version.empty()) return {};
    const auto [known, is_new] = known_.try_emplace(
        fmt::format("{} of {}", job.estimator, job.scenario), job.version, folder);
    if (is_new || known->second.first == job.version) return {};
    return failure(fmt::format(
        "{} and {} have two versions of {}: the scenario file or the source of a class in Python "
        "has changed between them; expected folders of one version; nothing was written, run one "
        "of them again",
        known->second.second.string(), folder.string(), known->first));
  }

 private:
  std::map<std::string, std::pair<std::string, fs::path>> known_;
};

}  // namespace

std::string MergedJob::outcome() const {
  if (is_missing()) return kMissing;
  return invalid() ? kInvalid : value_in(file, "outcome", kMissing);
}

bool MergedJob::is_done() const { return outcome() == name_of(JobOutcome::kDone); }

std::optional<std::string> MergedJob::invalid() const {
  if (!file.is_object() || !file.contains("sequence")) return std::nullopt;
  return invalid_reason(file["sequence"]);
}

std::size_t MergedSweep::count(std::string_view outcome) const {
  return static_cast<std::size_t>(std::count_if(
      jobs.begin(), jobs.end(), [&](const MergedJob& each) { return each.outcome() == outcome; }));
}

Result<MergedSweep> merge_sweeps(std::span<const fs::path> folders) {
  MergedSweep sweep;
  std::map<std::string, std::size_t> index;
  std::set<std::string> others;
  std::optional<FolderPlan> first;
  Versions versions;
  for (const fs::path& path : folders) {
    const JobStore folder(path);
    auto listed = folder.listed();
    if (!listed) return tl::unexpected(listed.error());
    const auto plan = folder.plan();
    if (!plan) return tl::unexpected(plan.error());
    const auto read = folder_plan(folder, *plan);
    if (!read) return tl::unexpected(read.error());
    if (!first) first = *read;
    if (auto same = check_plans(*first, *read); !same) {
      return tl::unexpected(same.error());
    }
    if (std::find(sweep.plans.begin(), sweep.plans.end(), *plan) == sweep.plans.end()) {
      sweep.plans.push_back(*plan);
    }
    for (ListedJob& job : *listed) {
      if (auto same = versions.add(path, job); !same) return tl::unexpected(same.error());
      const auto [at, added] = index.emplace(job.id, sweep.jobs.size());
      if (added) sweep.jobs.push_back({std::move(job), Json()});
    }
    for (const std::string& id : folder.ids()) {
      const auto at = index.find(id);
      if (at == index.end()) {
        others.insert(id);
        continue;
      }
      MergedJob& job = sweep.jobs[at->second];
      Json file = file_of(folder, id);
      if (file.is_null()) continue;
      const bool done = value_in(file, "outcome", "") == name_of(JobOutcome::kDone);
      if (!job.file.is_null() && done != job.is_done()) ++sweep.repeated;
      if (!job.is_done()) job.file = std::move(file);
    }
  }
  // A later folder may list what an earlier one has a result of.
  std::erase_if(others, [&](const std::string& id) { return index.contains(id); });
  sweep.others = others.size();
  return sweep;
}

Result<void> write_sweep_csv(const MergedSweep& sweep, const fs::path& file) {
  Columns parameters;
  Columns scores;
  for (const MergedJob& job : sweep.jobs) {
    if (!job.is_done()) continue;
    for (const auto& [key, unused] : member(job.file, "settings").items()) parameters.add(key);
    visit_leaves(member(job.file, "scores"), "",
                 [&](const std::string& key, const Json&) { scores.add(key); });
  }
  std::vector<std::string> header = {"id", "scenario", "seed", "estimator", "outcome"};
  for (const auto* columns : {&parameters, &scores}) {
    header.insert(header.end(), columns->names().begin(), columns->names().end());
  }
  CsvTable table(header);
  for (const MergedJob& job : sweep.jobs) {
    table.add(job.listed.id).add(job.listed.scenario).add(job.listed.seed);
    table.add(job.listed.estimator).add(job.outcome());
    if (job.is_done()) {
      std::map<std::string, Json> found;
      visit_leaves(member(job.file, "scores"), "",
                   [&](const std::string& key, const Json& value) { found[key] = value; });
      for (const std::string& key : parameters.names()) {
        add_cell(member(member(job.file, "settings"), key), table);
      }
      for (const std::string& key : scores.names()) add_cell(found[key], table);
    }
    table.end_row();
  }
  return write_csv(file, table);
}

TextTable merge_table(const MergedSweep& sweep) {
  const std::vector<std::string> outcomes = {"done",    "invalid",   "failed",
                                             "crashed", "timed_out", kMissing};
  TextTable table;
  table.header = {"scenario", "jobs"};
  table.header.insert(table.header.end(), outcomes.begin(), outcomes.end());
  Columns scenarios;
  std::map<std::string, std::map<std::string, std::size_t>> counts;
  for (const MergedJob& job : sweep.jobs) {
    scenarios.add(job.listed.scenario);
    ++counts[job.listed.scenario]["jobs"];
    ++counts[job.listed.scenario][job.outcome()];
  }
  for (const std::string& scenario : scenarios.names()) {
    std::vector<std::string> row = {scenario};
    for (std::size_t i = 1; i < table.header.size(); ++i) {
      row.push_back(fmt::format("{}", counts[scenario][table.header[i]]));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace aims
