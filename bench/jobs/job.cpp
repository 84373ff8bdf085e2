// SPDX-License-Identifier: BSD-3-Clause
#include "bench/jobs/job.hpp"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "bench/jobs/job_id.hpp"
#include "bench/run/code_version.hpp"

namespace aims {
namespace {

constexpr std::array kOutcomes = {JobOutcome::kDone, JobOutcome::kFailed, JobOutcome::kCrashed,
                                  JobOutcome::kTimedOut, JobOutcome::kNotSimulated};

}  // namespace

Job make_job(std::shared_ptr<const Scenario> scenario, std::uint64_t seed,
             EstimatorSpec estimator) {
  scenario = scenario_of_seed(std::move(scenario), seed);
  std::string id = job_id(*scenario, seed, text_of(estimator));
  return {std::move(scenario), seed, std::move(estimator), std::move(id)};
}

std::string point_text(const Job& job) {
  std::string text = unlabelled_text(job.estimator);
  for (const ScenarioSetting& each : job.scenario_settings) {
    text += fmt::format("+{}={}", each.key, each.value);
  }
  return text;
}

std::string text_of(const Job& job) {
  return fmt::format("{} seed {} {}", job.scenario->name, job.seed, point_text(job));
}

std::string_view name_of(JobOutcome outcome) {
  switch (outcome) {
    case JobOutcome::kDone:
      return "done";
    case JobOutcome::kFailed:
      return "failed";
    case JobOutcome::kCrashed:
      return "crashed";
    case JobOutcome::kTimedOut:
      return "timed_out";
    case JobOutcome::kNotSimulated:
      return "not_simulated";
  }
  return "";
}

std::optional<double> score_in(const JobResult& result, const std::string& key) {
  if (result.outcome != JobOutcome::kDone || !result.scores.is_object()) return std::nullopt;
  return number_at(result.scores, key);
}

Json job_json(const Job& job, const JobResult& result) {
  Json settings = Json::object();
  for (const auto& [key, value] : job.estimator.settings) settings[key] = value;
  Json defaults = Json::object();
  for (const ScenarioSetting& each : job.scenario_settings) {
    settings[each.key] = each.value;
    defaults[each.key] = each.default_value;
  }
  Json json = {{"schema", kJobSchema},
               {"id", job.id},
               {"code", code_version()},
               {"scenario", job.scenario->name},
               {"family", job.scenario->family},
               {"level", job.scenario->level},
               {"seed", job.seed},
               {"estimator", job.estimator.name},
               {"settings", std::move(settings)},
               {"outcome", name_of(result.outcome)}};
  if (!defaults.empty()) json["defaults"] = std::move(defaults);
  if (!result.message.empty()) json["message"] = result.message;
  if (!result.scores.is_null()) json["scores"] = result.scores;
  if (!result.sequence.is_null()) json["sequence"] = result.sequence;
  json["wall_s"] = result.wall_s;
  return json;
}

std::optional<JobResult> result_in(const Json& json) try {
  if (!json.is_object() || json.value("schema", Json()) != kJobSchema) return std::nullopt;
  JobResult result;
  for (const JobOutcome outcome : kOutcomes) {
    if (json.value("outcome", Json()) != name_of(outcome)) continue;
    result.outcome = outcome;
    result.message = json.value("message", "");
    result.scores = json.value("scores", Json());
    result.sequence = json.value("sequence", Json());
    result.wall_s = json.value("wall_s", 0.0);
    if (outcome == JobOutcome::kDone && !result.scores.is_object()) return std::nullopt;
    return result;
  }
  return std::nullopt;
} catch (const Json::exception&) {  // a value of another type
  return std::nullopt;
}

}  // namespace aims
