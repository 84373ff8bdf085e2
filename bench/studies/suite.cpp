// SPDX-License-Identifier: BSD-3-Clause
#include "bench/studies/suite.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <set>
#include <utility>

#include "bench/jobs/stored_results.hpp"
#include "bench/run/code_version.hpp"

namespace aims {
namespace {

/// Sorts the files into cases and failures; error for two cases of one name.
Result<Suite> suite_of(std::vector<ScenarioFile> scenarios) {
  Suite suite;
  std::set<std::string> names;
  for (auto& [file, scenario] : scenarios) {
    if (!scenario) {
      suite.failures.push_back({file.stem().string(), std::nullopt, "", scenario.error().message});
      continue;
    }
    if (!names.insert(scenario->name).second) {
      return failure(
          fmt::format("{}: a second scenario of the name '{}'", file.string(), scenario->name));
    }
    suite.cases.push_back({std::move(*scenario), {}, {}});
  }
  if (!suite.cases.empty()) suite.settings = settings_of(suite.cases.front().scenario);
  if (!suite.cases.empty()) return suite;
  if (suite.failures.empty()) return failure("no scenario is given");
  return failure(suite.failures.front().message);
}

/// The jobs of the case, by seed and estimator.
Result<void> add_jobs(const SuiteCase& each, std::vector<std::uint64_t> seeds,
                      std::vector<Job>& jobs) {
  const auto scenario = std::make_shared<const Scenario>(each.scenario);
  if (seeds.empty()) seeds = {static_cast<std::uint64_t>(scenario->seed)};
  std::sort(seeds.begin(), seeds.end());
  for (const std::uint64_t seed : seeds) {
    const auto drawn = scenario_of_seed(scenario, seed);
    for (const std::string& text : scenario->run) {
      auto spec = parse_estimator_spec(text);
      if (!spec) return tl::unexpected(spec.error());
      jobs.push_back(make_job(drawn, seed, std::move(*spec)));
    }
  }
  return {};
}

/// Notes a failure; that of a sequence once, for all estimators.
void add_failure(const Job& job, const JobResult& result, std::vector<RunFailure>& failures) {
  const bool of_all = result.outcome == JobOutcome::kNotSimulated;
  RunFailure failure{job.scenario->name, job.seed, of_all ? "" : job.estimator.label,
                     result.message};
  const bool noted = of_all && !failures.empty() && failures.back().seed == failure.seed &&
                     failures.back().scenario == failure.scenario;
  if (!noted) failures.push_back(std::move(failure));
}

}  // namespace

void collect_suite(const JobStore& store, Suite& suite) {
  std::size_t next = 0;
  for (SuiteCase& each : suite.cases) {
    bool ended = true;
    while (next < suite.jobs.size() && suite.jobs[next].scenario->name == each.scenario.name) {
      std::vector<LabelledResult> results;
      bool whole = true;
      const std::uint64_t seed = suite.jobs[next].seed;
      for (; next < suite.jobs.size() && suite.jobs[next].seed == seed &&
             suite.jobs[next].scenario->name == each.scenario.name;
           ++next) {
        const Job& job = suite.jobs[next];
        auto result = store.find(job.id);
        whole = whole && result;
        if (!result) continue;
        if (result->outcome != JobOutcome::kDone) {
          add_failure(job, *result, suite.failures);
        }
        results.push_back({job.estimator.label, std::move(*result)});
      }
      ended = ended && whole;
      RunRecord record = record_of(each.scenario.name, seed, results, whole);
      if (has_outcome(record)) each.runs.push_back(std::move(record));
    }
    suite.complete = suite.complete && ended;
    if (ended) each.expectations = check_expectations(each.scenario, each.runs);
  }
}

Result<Suite> run_suite(std::vector<ScenarioFile> scenarios, const SuiteOptions& options,
                        const JobObserver& observer) {
  auto suite = suite_of(std::move(scenarios));
  if (!suite) return suite;
  for (const SuiteCase& each : suite->cases) {
    if (auto added = add_jobs(each, options.seeds, suite->jobs); !added) {
      return tl::unexpected(added.error());
    }
  }
  const auto run = run_jobs({.jobs = suite->jobs,
                             .shard = options.shard,
                             .settings = suite->settings,
                             .force = options.jobs.redo},
                            options.jobs, observer);
  if (!run) return tl::unexpected(run.error());
  suite->run = *run;
  collect_suite(JobStore(options.jobs.out), *suite);
  return suite;
}

std::vector<std::string> left_out_lines(const Suite& suite) {
  std::vector<std::string> lines;
  for (const SuiteCase& each : suite.cases) {
    const std::string text = left_out_text(each.runs);
    if (!text.empty()) lines.push_back(fmt::format("{}: {}", each.scenario.name, text));
  }
  return lines;
}

Json study_head(std::string_view schema, const Suite& suite) {
  return {{"schema", schema},
          {"version", AIMS_VERSION},
          {"code", code_version()},
          {"complete", suite.complete}};
}

Json invalid_json(const Suite& suite) {
  Json json = Json::array();
  for (const SuiteCase& each : suite.cases) {
    for (const auto& [seed, reason] : invalid_runs(each.runs)) {
      json.push_back({{"scenario", each.scenario.name}, {"seed", seed}, {"reason", reason}});
    }
  }
  return json;
}

}  // namespace aims
