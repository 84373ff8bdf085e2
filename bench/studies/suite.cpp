// SPDX-License-Identifier: BSD-3-Clause
#include "bench/studies/suite.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <set>
#include <system_error>
#include <utility>

#include "bench/jobs/stored_results.hpp"
#include "bench/jobs/unit_store.hpp"
#include "bench/run/results.hpp"
#include "bench/run/weak_axis_series.hpp"
#include "bench/studies/suite_progress.hpp"
#include "bench/studies/suite_report.hpp"
#include "core/files/folder_lock.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

/// One scenario on one seed: what is stored of it and what it came to.
struct WorkItem {
  std::size_t scenario = 0;  ///< index among the cases
  std::uint64_t seed = 0;
  StoredUnits stored;
  std::optional<std::string> failure;

  bool finished() const { return !failure && stored.record && stored.missing.empty(); }
};

/// Claims `out`; an existing folder must be a suite's.
Result<FolderLock> claim(const fs::path& out) {
  std::error_code code;
  if (fs::exists(out) && !(fs::is_directory(out) && fs::is_empty(out)) && !holds_suite(out)) {
    return failure(
        fmt::format("{}: exists and is no suite's folder; give another --out", out.string()));
  }
  fs::create_directories(out, code);
  if (code) return failure(fmt::format("{}: {}", out.string(), code.message()));
  auto lock = FolderLock::take(out);
  if (!lock) {
    return failure(
        fmt::format("{}: another suite is writing there, or it cannot be written", out.string()));
  }
  return std::move(*lock);
}

/// Sorts the files into cases and failures; error for two cases of one name.
Result<Suite> suite_of(std::vector<ScenarioFile> scenarios) {
  Suite suite;
  std::set<std::string> names;
  for (auto& [file, scenario] : scenarios) {
    if (!scenario) {
      suite.failures.push_back({file.stem().string(), std::nullopt, scenario.error().message});
      continue;
    }
    if (!names.insert(scenario->name).second) {
      return failure(
          fmt::format("{}: a second scenario of the name '{}'", file.string(), scenario->name));
    }
    suite.cases.push_back({std::move(*scenario), {}, {}});
  }
  if (!suite.cases.empty()) return suite;
  if (suite.failures.empty()) return failure("no scenario is given");
  return failure(suite.failures.front().message);
}

std::vector<WorkItem> items_of(const Suite& suite, const SuiteOptions& options,
                               const UnitStore& store) {
  std::vector<WorkItem> items;
  for (std::size_t i = 0; i < suite.cases.size(); ++i) {
    const Scenario& scenario = suite.cases[i].scenario;
    std::vector<std::uint64_t> seeds = options.seeds;
    if (seeds.empty()) seeds = {static_cast<std::uint64_t>(scenario.seed)};
    std::sort(seeds.begin(), seeds.end());
    for (const std::uint64_t seed : seeds) {
      items.push_back({i, seed, store.find(scenario, seed), {}});
    }
  }
  return items;
}

/// Simulates what the item lacks and stores it. False when it was ended early.
Result<bool> run_item(const Scenario& scenario, const SuiteOptions& options, const UnitStore& store,
                      const Observer& observer, WorkItem& item) {
  Scenario lacking = scenario;
  lacking.estimators = item.stored.missing;
  const auto result = run(lacking, {item.seed, 1}, observer);
  if (!result) return tl::unexpected(result.error());
  if (!result->complete) return false;
  RunRecord record = record_of(lacking, *result, 0.0);
  if (options.weak_axis_series) add_weak_axis_series(*result, record);
  if (options.trajectories) {
    const fs::path folder = store.folder_of(scenario.name, item.seed);
    fs::create_directories(folder);
    if (auto written = write_streams(scenario, *result, folder); !written) {
      return tl::unexpected(written.error());
    }
  }
  if (item.stored.record) take_estimators(scenario, *item.stored.record, record);
  if (auto put = store.put(scenario, record); !put) return tl::unexpected(put.error());
  item.stored.record = std::move(record);
  item.stored.missing.clear();
  return true;
}

/// As `run_item`; whatever goes wrong becomes the item's failure.
void attempt(const Scenario& scenario, const SuiteOptions& options, const UnitStore& store,
             ProgressCount& count, WorkItem& item) {
  const auto observer = [&](const Progress& progress) { return count.advance(&item, progress); };
  try {
    const auto done = run_item(scenario, options, store, observer, item);
    if (!done) item.failure = done.error().message;
    if (!done || *done) count.finish(&item);
  } catch (const std::exception& error) {
    item.failure = error.what();
    count.finish(&item);
  }
}

/// Runs the items that are not finished, `jobs` at a time, in order.
void run_items(const Suite& suite, const SuiteOptions& options, const UnitStore& store,
               const SuiteObserver& observer, std::vector<WorkItem*> items) {
  ProgressCount count(items.size(), observer);
  std::atomic<std::size_t> next = 0;
  const auto work = [&](int) {
    while (count.wanted()) {
      const std::size_t index = next++;
      if (index >= items.size()) return;
      // An arena of one: whatever a run waits for, its thread does not start another run meanwhile.
      tbb::task_arena alone(1);
      alone.execute([&] {
        attempt(suite.cases[items[index]->scenario].scenario, options, store, count, *items[index]);
      });
    }
  };
  tbb::task_arena arena(options.jobs);
  arena.execute([&] { tbb::parallel_for(0, options.jobs, work, tbb::simple_partitioner()); });
}

/// Moves the items' results into the suite and checks the gates of cases that are finished.
void collect(std::vector<WorkItem> items, Suite& suite) {
  std::vector<bool> whole(suite.cases.size(), true);
  for (WorkItem& item : items) {
    SuiteCase& owner = suite.cases[item.scenario];
    if (item.failure) {
      suite.failures.push_back({owner.scenario.name, item.seed, std::move(*item.failure)});
    } else if (item.finished()) {
      owner.runs.push_back(std::move(*item.stored.record));
    } else {
      suite.complete = false;
    }
    whole[item.scenario] = whole[item.scenario] && item.finished();
  }
  for (std::size_t i = 0; i < suite.cases.size(); ++i) {
    SuiteCase& each = suite.cases[i];
    if (whole[i]) each.gates = check_gates(each.scenario, each.runs);
  }
}

}  // namespace

Result<Suite> run_suite(std::vector<ScenarioFile> scenarios, const SuiteOptions& options,
                        const SuiteObserver& observer) {
  auto suite = suite_of(std::move(scenarios));
  if (!suite) return suite;
  const auto lock = claim(options.out);
  if (!lock) return tl::unexpected(lock.error());
  const UnitStore store(options.out, options.weak_axis_series);
  std::vector<WorkItem> items = items_of(*suite, options, store);
  std::vector<WorkItem*> unfinished;
  for (WorkItem& item : items) {
    if (!item.finished()) unfinished.push_back(&item);
    for (const std::string& note : item.stored.notes) suite->notes.push_back(note);
  }
  suite->runs_reused = items.size() - unfinished.size();
  if (auto marked = mark_suite(options.out); !marked) return tl::unexpected(marked.error());

  run_items(*suite, options, store, observer, unfinished);
  for (const WorkItem* item : unfinished) suite->runs_done += item->finished();
  collect(std::move(items), *suite);
  if (auto written = write_suite(*suite, options.out); !written) {
    return tl::unexpected(written.error());
  }
  return suite;
}

}  // namespace aims
