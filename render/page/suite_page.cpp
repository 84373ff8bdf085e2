// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "bench/jobs/job_store.hpp"
#include "bench/jobs/stored_results.hpp"
#include "bench/scoring/json_text.hpp"
#include "bench/studies/comparison.hpp"
#include "bench/studies/dataset_benchmark.hpp"
#include "bench/studies/paper_study.hpp"
#include "bench/studies/suite_summary.hpp"
#include "bench/studies/written_runs.hpp"
#include "render/page/links.hpp"
#include "render/page/page_data.hpp"
#include "render/page/pages.hpp"
#include "render/page/series.hpp"
#include "render/page/suite_runs.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

/// Pictures of the paper's experiments beyond this size are left out [bytes].
constexpr std::uintmax_t kLargestPicture = 2 * 1024 * 1024;

/// Error for a suite.json whose scenarios cannot be gone through.
Result<void> check_scenarios(const Json& suite, const fs::path& file) {
  const Json& scenarios = member(suite, "scenarios");
  if (!scenarios.is_array()) {
    return failure(fmt::format("{}: scenarios: expected a list", file.string()));
  }
  for (std::size_t i = 0; i < scenarios.size(); ++i) {
    const Json& each = scenarios[i];
    const Json& seeds = member(each, "seeds");
    const bool whole = member(each, "name").is_string() && seeds.is_array() &&
                       member(each, "estimators").is_object() &&
                       std::all_of(seeds.begin(), seeds.end(),
                                   [](const Json& seed) { return seed.is_number_unsigned(); });
    if (whole) continue;
    return failure(
        fmt::format("{}: scenarios.{}: expected name, seeds and estimators", file.string(), i));
  }
  return {};
}

/// The record of that seed; null when there is none.
const RunRecord* record_in(const StoredResults& results, const std::string& scenario,
                           std::uint64_t seed) {
  const auto runs = results.find(scenario);
  if (runs == results.end()) return nullptr;
  const auto found = std::find_if(runs->second.begin(), runs->second.end(),
                                  [seed](const RunRecord& run) { return run.seed == seed; });
  return found == runs->second.end() ? nullptr : &*found;
}

/// A row per scenario and seed.
Json runs_of(const Json& suite, const fs::path& folder, const fs::path& page_folder,
             const Json& headline, Json& notes) {
  const StoredResults results = read_results(folder).value_or(StoredResults());
  Json runs = Json::array();
  for (const Json& scenario : suite["scenarios"]) {
    const std::string name = text_in(scenario, "name");
    for (const Json& json : scenario["seeds"]) {
      const auto seed = json.get<std::uint64_t>();
      const RunRecord* record = record_in(results, name, seed);
      if (record == nullptr) {
        notes.push_back(fmt::format("{}, seed {}: no results of its jobs", name, seed));
      }
      runs.push_back(suite_run_json(name, seed, record, suite_run_folder(folder, name, seed),
                                    page_folder, headline));
    }
  }
  return runs;
}

/// More scenarios than these are counted in a title, not named.
constexpr std::size_t kMostNames = 3;

/// The scenarios where they are few. Of more the name that the folder was given, or the content
/// where that is the one that `aims suite` takes by itself.
std::string title_of(const Json& suite, const fs::path& folder) {
  std::vector<std::string> scenarios;
  std::set<std::string> families;
  for (const Json& each : suite["scenarios"]) {
    scenarios.push_back(text_in(each, "name"));
    families.insert(text_in(each, "family"));
  }
  if (!scenarios.empty() && scenarios.size() <= kMostNames)
    return fmt::format("{}", fmt::join(scenarios, ", "));
  const std::string name = folder_name(folder);
  if (name != "suite") return name;
  const bool one_family = families.size() == 1 && !families.begin()->empty();
  if (one_family) return fmt::format("{}, {} levels", *families.begin(), scenarios.size());
  return fmt::format("{} scenarios, {} estimators", scenarios.size(),
                     suite_estimators(suite).size());
}

/// The file of a study in the folder, as `read` yields it; null where there is none, or a note
/// where it cannot be used.
Json study_part(const fs::path& folder, const char* name, Json& notes,
                const std::function<Result<Json>(const fs::path& file)>& read) {
  const fs::path file = folder / name;
  std::error_code ignored;
  if (!fs::exists(file, ignored)) return {};
  auto part = read(file);
  if (part) return std::move(*part);
  notes.push_back(fmt::format("{} cannot be used: {}", name, part.error().message));
  return {};
}

/// The ROC part: what is asked for, else what the folder has, else null.
Result<Json> detectors_of(const fs::path& folder, const fs::path& asked, PageData& page,
                          Json& notes) {
  constexpr const char* kName = "detectors.json";
  std::error_code ignored;
  if (!asked.empty()) {
    return detector_curves(fs::is_directory(asked, ignored) ? asked / kName : asked, page);
  }
  return study_part(folder, kName, notes,
                    [&](const fs::path& file) { return detector_curves(file, page); });
}

/// The file of `aims study paper` and its pictures; null in other folders.
Result<Json> paper_of(const fs::path& folder, Json& notes) {
  Json paper = study_part(folder, "paper.json", notes,
                          [](const fs::path& file) { return read_json_of(file, kPaperSchema); });
  if (paper.is_null()) return paper;
  std::vector<PagePicture> pictures;
  for (const Json& each : member(paper, "experiments")) {
    const std::string name = text_in(each, "scenario");
    pictures.push_back(
        {name + "-trajectories", name + ": trajectories over the plan, height, error"});
    pictures.push_back({name + "-maps", name + ": maps from above and from the side"});
  }
  auto shown = pictures_json(folder, pictures, kLargestPicture, notes);
  if (!shown) return shown;
  paper["pictures"] = std::move(*shown);
  return paper;
}

/// What changed from `against` to the suite; null when there is nothing to compare with.
Result<Json> comparison_of(const fs::path& folder, const fs::path& against) {
  if (against.empty()) return Json();
  const auto before = read_results(against);
  if (!before) return tl::unexpected(before.error());
  const auto after = read_results(folder);
  if (!after) return tl::unexpected(after.error());
  const Comparison comparison = with_settings(
      compare(*before, *after), JobStore(against).settings(), JobStore(folder).settings());
  Json json = comparison_json(comparison, folder_name(against), folder_name(folder));
  json["summary"] = summary_text(comparison);
  json["differs"] = settings_text(comparison);
  return json;
}

}  // namespace

Result<PageData> suite_page(const fs::path& folder, const PageOptions& options) {
  if (auto ok = check_links(folder); !ok) return tl::unexpected(ok.error());
  const fs::path file = folder / "suite.json";
  auto suite = read_json_of(file, kSuiteSchema);
  if (!suite) return tl::unexpected(suite.error());
  if (auto checked = check_scenarios(*suite, file); !checked) {
    return tl::unexpected(checked.error());
  }
  PageData page;
  page.title = title_of(*suite, folder);
  Json notes = Json::array();
  auto detectors = detectors_of(folder, options.detectors, page, notes);
  if (!detectors) return tl::unexpected(detectors.error());
  Json consistency = study_part(folder, "consistency.json", notes, [&](const fs::path& each) {
    return consistency_series(each, page);
  });
  auto comparison = comparison_of(folder, options.against);
  if (!comparison) return tl::unexpected(comparison.error());
  auto paper = paper_of(folder, notes);
  if (!paper) return tl::unexpected(paper.error());
  Json benchmark = study_part(folder, "benchmark.json", notes, [](const fs::path& each) {
    return read_json_of(each, kBenchmarkSchema);
  });
  if (!benchmark.is_null() && !text_in(benchmark, "title").empty()) {
    page.title = text_in(benchmark, "title");
  }
  const std::string lead = text_in(benchmark, "score");
  const Json headline = headline_keys(lead);
  const fs::path page_folder = options.out_folder.empty() ? folder : options.out_folder;
  Json runs = runs_of(*suite, folder, page_folder, headline, notes);
  page.json = {{"schema", kPageSchema},
               {"kind", "suite"},
               {"title", page.title},
               {"version", text_in(*suite, "version")},
               {"score_list", score_list_json(lead, text_in(benchmark, "unit"))},
               {"headline", headline},
               {"runs", std::move(runs)},
               {"roc", std::move(*detectors)},
               {"consistency", std::move(consistency)},
               {"compare", std::move(*comparison)},
               {"paper", std::move(*paper)},
               {"benchmark", std::move(benchmark)},
               {"notes", std::move(notes)}};
  page.json["palette"] = palette_json();
  page.json["styles"] = styles_json(suite_estimators(*suite));
  page.json["suite"] = std::move(*suite);
  return page;
}

}  // namespace aims
