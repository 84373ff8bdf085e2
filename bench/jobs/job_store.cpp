// SPDX-License-Identifier: BSD-3-Clause
#include "bench/jobs/job_store.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <system_error>

#include "bench/run/code_version.hpp"
#include "bench/run/sequence.hpp"
#include "bench/scoring/json_text.hpp"
#include "core/files/atomic_file.hpp"
#include "core/files/csv.hpp"
#include "core/files/csv_columns.hpp"
#include "core/text.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

constexpr const char* kListFile = "jobs.csv";
constexpr const char* kPlanFile = "plan.yaml";
constexpr const char* kSettingsFile = "settings.txt";
constexpr std::string_view kCodeLine = "# code ";

/// plan.yaml: the plan, and the code that its ids are of.
std::string plan_file_text(const std::string& plan) {
  return fmt::format("# aims sweep\n{}{}\n{}", kCodeLine, code_version(), plan);
}

std::string job_list(std::span<const Job> jobs) {
  CsvTable table({"id", "scenario", "seed", "label", "estimator", "version"});
  for (const Job& job : jobs) {
    table.add(job.id).add(job.scenario->name).add(job.seed);
    table.add(job.estimator.label).add(point_text(job)).add(job.version).end_row();
  }
  return table.text();
}

/// The line of `text` that begins with `start`; empty when there is none.
std::string line_of(const std::string& text, std::string_view start) {
  for (const std::string& line : split(text, '\n')) {
    if (line.starts_with(start)) return line.substr(start.size());
  }
  return "";
}

/// Of two texts, the first line of `theirs` that `ours` has otherwise.
std::string first_difference(const std::string& theirs, const std::string& ours) {
  const auto a = split(theirs, '\n');
  const auto b = split(ours, '\n');
  const auto [left, right] = std::ranges::mismatch(a, b);
  return left == a.end() ? "(fewer lines)" : *left;
}

/// Why the folder's jobs are not these; empty when they are, whatever else the plan holds.
std::string mismatch(const std::string& plan_there, const std::string& plan_here,
                     const std::string& list_there, const std::string& list_here) {
  const std::string code_there = line_of(plan_there, kCodeLine);
  if (code_there != code_version()) {
    return fmt::format("holds jobs of code {}, and this is code {}", code_there, code_version());
  }
  if (list_there == list_here) return "";
  if (plan_there != plan_here) {
    return fmt::format("holds jobs of another plan, with '{}'",
                       first_difference(plan_there, plan_here));
  }
  return "holds jobs of other scenarios or estimators: a scenario file has changed, or the source "
         "of a "
         "class in Python";
}

/// "--set a=1 --set b=2", or that there is none.
std::string options_text(const std::string& settings) {
  std::string text;
  for (const std::string& line : split(settings, '\n')) {
    text += fmt::format("{}--set {}", text.empty() ? "" : " ", line);
  }
  return text.empty() ? "no --set" : text;
}

/// A folder that is not there, is a job store, or holds nothing but what a claim leaves.
bool is_store_or_empty(const fs::path& folder) {
  std::error_code ignored;
  if (!fs::exists(folder, ignored)) return true;
  if (!fs::is_directory(folder, ignored)) return false;
  for (const char* mark : {kListFile, kPlanFile, "tune.yaml"}) {
    if (fs::exists(folder / mark, ignored)) return true;
  }
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    const fs::path name = entry.path().filename();
    if (name != ".lock" && name != "shards" && name.extension() != ".tmp") return false;
  }
  return true;
}

/// True while another process holds the lock that a claim leaves in the folder.
bool is_claimed(const fs::path& folder) {
  std::error_code ignored;
  const fs::path lock = folder / ".lock";
  return fs::exists(lock, ignored) && !FolderLock::take_file(lock);
}

}  // namespace

Result<void> JobStore::enter(std::span<const Job> jobs, const std::string& plan, bool force) const {
  const std::string list_here = job_list(jobs);
  if (plan.empty()) return write_file_atomically(folder_ / kListFile, list_here);
  const std::string plan_here = plan_file_text(plan);
  const auto plan_there = read_file(folder_ / kPlanFile);
  if (plan_there) {
    const auto list_there = read_file(folder_ / kListFile);
    // Without a list, whoever wrote the plan was ended before it wrote that.
    const std::string why =
        mismatch(*plan_there, plan_here, list_there.value_or(list_here), list_here);
    if (!why.empty() && !force) {
      return failure(fmt::format(
          "{}: {}; give another --out, or --force to continue here (valid results stay)",
          folder_.string(), why));
    }
    if (why.empty() && list_there && *plan_there == plan_here) return {};
  }
  if (auto written = write_file_atomically(folder_ / kPlanFile, plan_here); !written) {
    return written;
  }
  return write_file_atomically(folder_ / kListFile, list_here);
}

Result<void> JobStore::check_settings(const std::vector<std::string>& settings) const {
  const auto there = read_file(folder_ / kSettingsFile);
  const std::string here = fmt::format("{}", fmt::join(settings, "\n"));
  if (!there || *there == here) return {};
  return failure(line_text(
      fmt::format("{}: holds results with {}, and this command has {}; give another --out, or "
                  "--overwrite to replace them",
                  folder_.string(), options_text(*there), options_text(here))));
}

std::vector<std::string> JobStore::settings() const {
  return split(read_file(folder_ / kSettingsFile).value_or(""), '\n');
}

Result<void> JobStore::keep_settings(const std::vector<std::string>& settings) const {
  return write_file_atomically(folder_ / kSettingsFile,
                               fmt::format("{}", fmt::join(settings, "\n")));
}

std::uint64_t seed_of(const ListedJob& job) {
  std::uint64_t seed = 0;
  std::from_chars(job.seed.data(), job.seed.data() + job.seed.size(), seed);
  return seed;
}

Result<std::vector<ListedJob>> JobStore::listed() const {
  if (!fs::exists(folder_ / kListFile)) {
    return failure(fmt::format("{}: holds no results: no {}", folder_.string(), kListFile));
  }
  const auto table = CsvColumns::read(folder_ / kListFile);
  if (!table) return tl::unexpected(table.error());
  const auto ids = table->texts("id");
  const auto scenarios = table->texts("scenario");
  const auto seeds = table->texts("seed");
  const auto labels = table->texts("label");
  const auto estimators = table->texts("estimator");
  for (const auto* column : {&ids, &scenarios, &seeds, &labels, &estimators}) {
    if (column->size() == table->rows()) continue;
    return failure(fmt::format("{}: expected the columns id, scenario, seed, label, estimator",
                               (folder_ / kListFile).string()));
  }
  const auto versions = table->texts("version");  // older lists have none
  std::vector<ListedJob> jobs;
  for (std::size_t i = 0; i < table->rows(); ++i) {
    jobs.push_back({ids[i], scenarios[i], seeds[i], labels[i], estimators[i],
                    i < versions.size() ? versions[i] : ""});
  }
  return jobs;
}

Result<std::string> JobStore::plan() const { return read_file(folder_ / kPlanFile); }

Result<std::string> JobStore::code() const {
  return plan().map([](const std::string& text) { return line_of(text, kCodeLine); });
}

std::optional<Json> JobStore::read(const std::string& id) const {
  const auto text = read_file(file_of(id));
  if (!text) return std::nullopt;
  auto json = parse_json(*text, id);
  return json ? std::optional<Json>(std::move(*json)) : std::nullopt;
}

std::optional<JobResult> JobStore::find(const std::string& id) const {
  const auto json = read(id);
  return json ? result_in(*json) : std::nullopt;
}

Result<void> JobStore::put(const Job& job, const JobResult& result) const {
  std::error_code code;
  fs::create_directories(folder_ / "jobs", code);
  return write_json(file_of(job.id), job_json(job, result), 1);
}

std::vector<std::string> JobStore::ids() const {
  std::vector<std::string> ids;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder_ / "jobs", ignored)) {
    if (entry.path().extension() == ".json") ids.push_back(entry.path().stem().string());
  }
  std::sort(ids.begin(), ids.end());
  return ids;
}

bool JobStore::has(const std::string& id, const std::string& sequence,
                   const JobOutputs& outputs) const {
  std::error_code ignored;
  const auto is_there = [&](const fs::path& file) { return fs::exists(file, ignored); };
  if (outputs.weak_axis && !is_there(outputs_of(id) / kWeakAxisFile)) return false;
  if (!outputs.trajectories) return true;
  if (!is_there(outputs_of(id) / fmt::format("{}.diagnostics.csv", kEstimateName))) return false;
  return std::all_of(std::begin(kSequenceFiles), std::end(kSequenceFiles),
                     [&](const char* name) { return is_there(sequence_of(sequence) / name); });
}

Result<StoreClaim> claim_store(const fs::path& folder, const Shard& shard) {
  const auto refusal = [&](const std::string& why) {
    return failure(fmt::format("{}: {}", folder.string(), why));
  };
  constexpr const char* kInUse = "in use by another aims command, which is writing there";
  if (!is_store_or_empty(folder)) {
    if (is_claimed(folder)) return refusal(kInUse);
    return refusal("exists and is no folder of aims results; give another --out");
  }
  const bool alone = shard.count == 1;
  const fs::path own = folder / "shards" / fmt::format("{}-of-{}", shard.index, shard.count);
  std::error_code code;
  fs::create_directories(alone ? folder : own, code);
  if (code) return refusal(code.message());
  auto lock = alone ? FolderLock::take(folder) : FolderLock::share(folder);
  if (!lock) return refusal(is_claimed(folder) ? kInUse : "cannot be written");
  StoreClaim claim{std::move(*lock), std::nullopt};
  if (alone) return claim;
  if (auto taken = FolderLock::take(own)) claim.shard.emplace(std::move(*taken));
  if (claim.shard) return claim;
  return refusal(fmt::format("another process works on shard {}/{}", shard.index, shard.count));
}

}  // namespace aims
