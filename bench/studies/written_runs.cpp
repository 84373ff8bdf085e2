// SPDX-License-Identifier: BSD-3-Clause
#include "bench/studies/written_runs.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <system_error>

#include "bench/jobs/sequence_cache.hpp"
#include "bench/run/sequence.hpp"
#include "bench/run/summary.hpp"
#include "bench/scoring/json_text.hpp"
#include "bench/scoring/result_files.hpp"
#include "bench/scoring/score_record.hpp"
#include "bench/scoring/tables.hpp"
#include "bench/studies/suite_summary.hpp"
#include "core/files/atomic_file.hpp"
#include "core/files/manifest.hpp"

namespace aims {

namespace {

namespace fs = std::filesystem;

/// Makes `to` the same file as `from`, or a copy where the disk knows no links.
Result<void> link_or_copy(const fs::path& from, const fs::path& to) {
  std::error_code code;
  fs::remove(to, code);
  fs::create_hard_link(from, to, code);
  if (!code) return {};
  fs::copy_file(from, to, fs::copy_options::overwrite_existing, code);
  if (!code) return {};
  return failure(fmt::format("{}: {}", to.string(), code.message()));
}

/// Removes what aims wrote into the folder, and the folder where nothing else is in it.
void remove_written(const fs::path& folder) {
  std::error_code ignored;
  const auto written = listed_files(folder);
  if (!written) return;
  for (const std::string& name : *written) {
    if (name.find('/') == std::string::npos) fs::remove(folder / name, ignored);
  }
  fs::remove(folder / kManifestFile, ignored);
  fs::remove(folder, ignored);
}

/// Does so in each folder seed-N of `parent`.
void remove_seeds(const fs::path& parent) {
  for (const fs::path& seed : seed_folders_in(parent)) remove_written(seed);
}

/// Links the outputs of the run's jobs under the labels of their estimators; their names.
Result<FileList> link_outputs(const JobStore& store, const Suite& suite,
                              const std::string& scenario, std::uint64_t seed,
                              const fs::path& folder) {
  FileList files;
  for (const Job& job : suite.jobs) {
    if (job.scenario->name != scenario || job.seed != seed) continue;
    const auto link = [&](const fs::path& from, const std::string& name) -> Result<void> {
      std::error_code ignored;
      if (!fs::exists(from, ignored)) return {};
      files.insert(name);
      return link_or_copy(from, folder / name);
    };
    for (const char* ending : kEstimatorFiles) {
      auto linked = link(store.outputs_of(job.id) / (std::string(kEstimateName) + ending),
                         job.estimator.label + ending);
      if (!linked) return tl::unexpected(linked.error());
    }
    const fs::path shared = store.sequence_of(SequenceCache::id_of(*job.scenario, seed));
    for (const char* name : kSequenceFiles) {
      if (auto linked = link(shared / name, name); !linked) return tl::unexpected(linked.error());
    }
  }
  return files;
}

bool has_several_seeds(const Suite& suite) {
  return suite.jobs.front().seed != suite.jobs.back().seed;
}

/// Writes the manifest of the folder of several runs, from those of `files` that are there.
Result<void> list_files(const fs::path& out, const FileList& files) {
  std::error_code ignored;
  FileList there;
  for (const std::string& file : files) {
    if (fs::exists(out / file, ignored)) there.insert(file);
  }
  return write_manifest(out, there);
}

}  // namespace

void remove_earlier_runs(const fs::path& out) {
  remove_seeds(out);
  std::error_code ignored;
  std::vector<fs::path> scenarios;
  for (const auto& entry : fs::directory_iterator(out / "runs", ignored)) {
    if (entry.is_directory(ignored)) scenarios.push_back(entry.path());
  }
  for (const fs::path& scenario : scenarios) {
    remove_seeds(scenario);
    fs::remove(scenario, ignored);
  }
  fs::remove(out / "runs", ignored);
  remove_written(out);
}

Result<void> write_run(const JobStore& store, const Suite& suite, const SuiteCase& each,
                       const RunRecord& record, const fs::path& folder) {
  std::error_code code;
  fs::create_directories(folder, code);
  if (code) return failure(fmt::format("{}: {}", folder.string(), code.message()));
  auto files = link_outputs(store, suite, each.scenario.name, record.seed, folder);
  if (!files) return tl::unexpected(files.error());
  files->insert({"config.yaml", "scores.csv", "scores.json"});
  const RunRecord own{record.seed, run_scores(each.scenario, record)};
  auto written =
      write_file_atomically(folder / "config.yaml", effective_config(each.scenario, record.seed));
  if (written) written = write_record(own, folder);
  return written ? write_manifest(folder, *files) : written;
}

Json run_scores(const Scenario& scenario, const RunRecord& record) {
  Json scores = record.scores;
  scores["expectations"] = json_array(check_expectations(scenario, {&record, 1}), check_json);
  return scores;
}

Json run_json(const Suite& suite, const fs::path& out) {
  const SuiteCase& only = suite.cases.front();
  Json json = {{"schema", "aims.run/1"},    {"scenario", only.scenario.name},
               {"out", out.string()},       {"complete", suite.complete},
               {"runs", Json::array()},     {"failures", failures_json(suite.failures)},
               {"settings", suite.settings}};
  for (const RunRecord& run : only.runs) json["runs"].push_back(run_scores(only.scenario, run));
  return json;
}

std::vector<fs::path> run_folders(const Suite& suite, const fs::path& out) {
  const bool several = has_several_seeds(suite);
  std::vector<fs::path> folders;
  for (const RunRecord& run : suite.cases.front().runs) {
    folders.push_back(several ? out / seed_folder_name(run.seed) : out);
  }
  return folders;
}

Result<void> write_runs(const Suite& suite, const fs::path& out) {
  const JobStore store(out);
  const SuiteCase& only = suite.cases.front();
  const std::vector<fs::path> folders = run_folders(suite, out);
  remove_earlier_runs(out);
  for (std::size_t i = 0; i < only.runs.size(); ++i) {
    auto written = write_run(store, suite, only, only.runs[i], folders[i]);
    if (!written) return written;
  }
  if (!has_several_seeds(suite)) return {};
  auto written = write_summary({only.scenario, only.runs, suite.failures, suite.complete}, out);
  if (!written) return written;
  return list_files(out, {"summary.md", "summary.csv", "summary.json", "summary.tex"});
}

fs::path suite_run_folder(const fs::path& out, const std::string& scenario, std::uint64_t seed) {
  return out / "runs" / scenario / seed_folder_name(seed);
}

Result<void> write_suite_runs(const Suite& suite, const fs::path& out) {
  const JobStore store(out);
  for (const SuiteCase& each : suite.cases) {
    for (const RunRecord& run : each.runs) {
      auto written =
          write_run(store, suite, each, run, suite_run_folder(out, each.scenario.name, run.seed));
      if (!written) return written;
    }
  }
  return {};
}

Result<void> list_suite(const fs::path& out) {
  return list_files(out, {"suite.md", "suite.csv", "suite.json", "suite.tex", "timings.csv"});
}

}  // namespace aims
