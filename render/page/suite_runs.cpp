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
  for (const std::string key : headline) outcome[key] = json_of(find_score(run, estimator, key));
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

Json headline_keys(const std::string& first) {
  Json keys = Json::array();
  if (!first.empty()) keys.push_back(first);
  for (const Score& each : headline_scores()) {
    if (each.key != first) keys.push_back(each.key);
  }
  return keys;
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
