// SPDX-License-Identifier: BSD-3-Clause
#include "bench/jobs/sweep_unit.hpp"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "bench/jobs/unit_id.hpp"
#include "bench/run/code_version.hpp"

namespace aims {
namespace {

constexpr std::array kOutcomes = {UnitOutcome::kDone, UnitOutcome::kFailed, UnitOutcome::kCrashed,
                                  UnitOutcome::kTimedOut};

}  // namespace

SweepUnit make_unit(std::shared_ptr<const Scenario> scenario, std::uint64_t seed,
                    EstimatorSpec estimator) {
  std::string id = unit_id(*scenario, seed, text_of(estimator));
  return {std::move(scenario), seed, std::move(estimator), std::move(id)};
}

std::string point_text(const SweepUnit& unit) {
  std::string text = unlabelled_text(unit.estimator);
  for (const ScenarioSetting& each : unit.scenario_settings) {
    text += fmt::format("+{}={}", each.key, each.value);
  }
  return text;
}

std::string text_of(const SweepUnit& unit) {
  return fmt::format("{} seed {} {}", unit.scenario->name, unit.seed, point_text(unit));
}

std::string_view name_of(UnitOutcome outcome) {
  switch (outcome) {
    case UnitOutcome::kDone:
      return "done";
    case UnitOutcome::kFailed:
      return "failed";
    case UnitOutcome::kCrashed:
      return "crashed";
    case UnitOutcome::kTimedOut:
      return "timed_out";
  }
  return "";
}

std::optional<double> score_in(const UnitResult& result, const std::string& key) {
  if (result.outcome != UnitOutcome::kDone || !result.scores.is_object()) return std::nullopt;
  RunRecord record;
  record.scores["estimators"]["it"] = result.scores;
  return find_score(record, "it", key);
}

Json unit_json(const SweepUnit& unit, const UnitResult& result) {
  Json settings = Json::object();
  for (const auto& [key, value] : unit.estimator.settings) settings[key] = value;
  Json untuned = Json::object();
  for (const ScenarioSetting& each : unit.scenario_settings) {
    settings[each.key] = each.value;
    untuned[each.key] = each.untuned;
  }
  Json json = {{"schema", kUnitSchema},
               {"id", unit.id},
               {"code", code_version()},
               {"scenario", unit.scenario->name},
               {"family", unit.scenario->family},
               {"level", unit.scenario->level},
               {"seed", unit.seed},
               {"estimator", unit.estimator.name},
               {"settings", std::move(settings)},
               {"outcome", name_of(result.outcome)}};
  if (!untuned.empty()) json["untuned"] = std::move(untuned);
  if (!result.message.empty()) json["message"] = result.message;
  if (!result.scores.is_null()) json["scores"] = result.scores;
  json["wall_s"] = result.wall_s;
  return json;
}

std::optional<UnitResult> result_in(const Json& json) try {
  if (!json.is_object() || json.value("schema", Json()) != kUnitSchema) return std::nullopt;
  UnitResult result;
  for (const UnitOutcome outcome : kOutcomes) {
    if (json.value("outcome", Json()) != name_of(outcome)) continue;
    result.outcome = outcome;
    result.message = json.value("message", "");
    result.scores = json.value("scores", Json());
    result.wall_s = json.value("wall_s", 0.0);
    if (outcome == UnitOutcome::kDone && !result.scores.is_object()) return std::nullopt;
    return result;
  }
  return std::nullopt;
} catch (const Json::exception&) {  // a value of another type
  return std::nullopt;
}

}  // namespace aims
