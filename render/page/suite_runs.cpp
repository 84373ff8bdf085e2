// SPDX-License-Identifier: BSD-3-Clause
#include "render/page/suite_runs.hpp"

#include <algorithm>
#include <vector>

#include "bench/scoring/json_text.hpp"
#include "bench/scoring/score_statistics.hpp"
#include "bench/scoring/validity.hpp"
#include "render/page/links.hpp"
#include "render/page/page.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

/// What the page shows of one estimator on one seed.
Json outcome_of(const RunRecord& run, const std::string& estimator, const Json& headline) {
  const Json& scores = estimator_in(run, estimator);
  Json outcome = {{"success", member(scores, "success")},
                  {"diverged_at_s", json_of(find_score(run, estimator, "diverged_at_s"))},
                  {"diverged_reason", text_in(scores, "diverged_reason")}};
  for (const Json& score : headline) {
    const std::string key = text_in(score, "key");
    outcome[key] = json_of(find_score(run, estimator, key));
  }
  return outcome;
}

/// The link to a run's own page; null when none lies there.
Json run_link(const fs::path& run_folder, const fs::path& page_folder) {
  std::error_code ignored;
  if (!fs::exists(run_folder / kPageFile, ignored)) return {};
  const fs::path target = fs::weakly_canonical(run_folder, ignored) / kPageFile;
  return link_to(target.lexically_relative(fs::weakly_canonical(page_folder, ignored)));
}

}  // namespace

Json suite_run_json(const std::string& scenario, std::uint64_t seed, const RunRecord* record,
                    const fs::path& run_folder, const fs::path& page_folder, const Json& headline) {
  Json run = {{"scenario", scenario},
              {"seed", seed},
              {"href", run_link(run_folder, page_folder)},
              {"invalid", Json()},
              {"partial", Json::array()},
              {"estimators", Json::object()}};
  if (record == nullptr) return run;
  run["partial"] = partial_in(*record);
  if (const auto reason = invalid_reason(record->scores)) run["invalid"] = *reason;
  for (const auto& [estimator, unused] : record->scores["estimators"].items()) {
    run["estimators"][estimator] = outcome_of(*record, estimator, headline);
  }
  return run;
}

Json headline_scores_json(const std::string& first, const std::string& unit) {
  Json scores = Json::array();
  const auto add = [&scores](const std::string& key, std::string_view title, std::string_view of) {
    scores.push_back({{"key", key},
                      {"title", title},
                      {"unit", of},
                      {"better", better_of(key) == Better::kLarger ? "larger" : "smaller"}});
  };
  if (!first.empty()) {
    const auto listed = std::ranges::find_if(
        score_list(), [&first](const Score& each) { return each.key == first; });
    const bool titled = listed != score_list().end() && !listed->title.empty();
    add(first, titled ? listed->title : std::string_view(first), unit);
  }
  for (const Score& each : headline_scores()) {
    if (each.key != first) add(each.key, each.title, each.unit);
  }
  return scores;
}

std::vector<std::string> suite_estimators(const Json& suite) {
  std::vector<std::string> names;
  for (const Json& scenario : member(suite, "scenarios")) {
    for (const auto& [name, unused] : member(scenario, "estimators").items()) {
      if (std::ranges::find(names, name) == names.end()) names.push_back(name);
    }
  }
  return names;
}

}  // namespace aims
