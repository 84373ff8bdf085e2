// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "bench/run/expectations.hpp"
#include "bench/scenario/scenario.hpp"
#include "bench/scoring/json_text.hpp"
#include "bench/scoring/result_files.hpp"
#include "bench/studies/suite_summary.hpp"
#include "core/files/atomic_file.hpp"
#include "render/page/links.hpp"
#include "render/page/pages.hpp"
#include "render/page/run_folder.hpp"
#include "render/page/series.hpp"
#include "render/page/suite_runs.hpp"
#include "sim/environment/scene_config.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

/// The scenario of a run, without its estimators; without more than a name where its configuration
/// cannot be read.
Scenario scenario_of(const fs::path& run_folder, const RunRecord& record, Json& notes) {
  Scenario scenario;
  scenario.name = text_in(record.scores, "scenario");
  const fs::path file = run_folder / "config.yaml";
  if (fs::exists(file)) {
    auto read = load_scenario(file, {});
    if (!read) notes.push_back("Without settings and expectations: " + read.error().message);
    if (read) scenario = std::move(*read);
  }
  scenario.run.clear();
  return scenario;
}

/// What summary.json says of all seeds: failures, settings, whether all jobs have ended.
void add_summary(const fs::path& folder, Json& suite, Json& notes) {
  const fs::path file = folder / "summary.json";
  std::error_code ignored;
  if (!fs::exists(file, ignored)) return;
  const auto text = read_file(file);
  const auto summary = text ? parse_json(*text, "summary.json") : tl::unexpected(text.error());
  if (!summary) {
    notes.push_back("Without failures and settings: " + summary.error().message);
    return;
  }
  for (const char* key : {"failures", "settings", "complete"}) {
    if (summary->is_object() && summary->contains(key)) suite[key] = (*summary)[key];
  }
}

/// "1-3", "1, 3" or "4".
std::string seeds_text(const std::vector<RunRecord>& runs) {
  std::vector<std::uint64_t> seeds;
  for (const RunRecord& each : runs) seeds.push_back(each.seed);
  const bool range = seeds.size() > 1 && seeds.back() - seeds.front() + 1 == seeds.size();
  if (range) return fmt::format("{}–{}", seeds.front(), seeds.back());
  return fmt::format("{}", fmt::join(seeds, ", "));
}

/// The folders seed-N that hold a run, by N; one on which every estimator failed has no truth.
std::vector<fs::path> folders_of_seeds(const fs::path& folder) {
  std::vector<fs::path> runs = seed_folders_in(folder);
  std::erase_if(runs, [](const fs::path& each) { return !holds_run(each); });
  return runs;
}

}  // namespace

std::vector<fs::path> seed_folders(const fs::path& folder) {
  std::vector<fs::path> runs = folders_of_seeds(folder);
  std::erase_if(runs, [](const fs::path& each) { return !fs::exists(each / "truth.tum"); });
  return runs;
}

bool holds_seeds(const fs::path& folder) {
  return std::ranges::any_of(folders_of_seeds(folder),
                             [](const fs::path& each) { return fs::exists(each / "scores.json"); });
}

Result<PageData> seeds_page(const fs::path& folder, const PageOptions& options) {
  if (auto ok = check_links(folder); !ok) return tl::unexpected(ok.error());
  Json notes = Json::array();
  Json rows = Json::array();
  SuiteCase only;
  const fs::path page_folder = options.out_folder.empty() ? folder : options.out_folder;
  for (const fs::path& run_folder : folders_of_seeds(folder)) {
    if (!fs::exists(run_folder / "scores.json")) continue;
    auto record = read_record(run_folder / "scores.json");
    if (!record) return tl::unexpected(record.error());
    if (only.runs.empty()) only.scenario = scenario_of(run_folder, *record, notes);
    rows.push_back(suite_run_json(only.scenario.name, record->seed, &*record, run_folder,
                                  page_folder, headline_keys()));
    only.runs.push_back(std::move(*record));
  }
  if (only.runs.empty()) return failure(folder.string() + ": expected seed-N/scores.json");
  only.scenario.run = estimators_in(only.runs);
  only.expectations = check_expectations(only.scenario, only.runs);
  PageData page;
  page.title = fmt::format("{}, seeds {}", only.scenario.name, seeds_text(only.runs));
  const std::string version = text_in(only.runs.front().scores, "version");
  const bool corridor = only.scenario.simulation.scene.kind == SceneKind::kCorridor;
  // What was set stands in a line of its own.
  const std::string description = description_without_settings(only.scenario.description);
  Suite suite;
  suite.cases.push_back(std::move(only));
  Json summary = suite_json(suite);
  add_summary(folder, summary, notes);
  page.json = {{"schema", kPageSchema},
               {"kind", "suite"},
               {"title", page.title},
               {"description", description},
               {"corridor", corridor},
               {"version", version},
               {"palette", palette_json()},
               {"styles", styles_json(suite_estimators(summary))},
               {"score_list", score_list_json()},
               {"headline", headline_keys()},
               {"runs", std::move(rows)},
               {"roc", nullptr},
               {"compare", nullptr},
               {"paper", nullptr},
               {"notes", std::move(notes)},
               {"suite", std::move(summary)}};
  return page;
}

}  // namespace aims
