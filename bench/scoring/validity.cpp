// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scoring/validity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "bench/scoring/json_text.hpp"

namespace aims {
namespace {

constexpr std::array kEnds = {WalkEnd::kRunning,        WalkEnd::kRouteDone,  WalkEnd::kFell,
                              WalkEnd::kLeftScene,      WalkEnd::kNoProgress, WalkEnd::kTimeLimit,
                              WalkEnd::kUnstablePhysics};

/// Why the walk did not end at the end of its route; empty when it did.
std::string reason_of(WalkEnd end, double end_s) {
  switch (end) {
    case WalkEnd::kRouteDone:
      return "";
    case WalkEnd::kFell:
      return fmt::format("the robot fell at {:.1f} s", end_s);
    case WalkEnd::kLeftScene:
      return fmt::format("the robot left the scene at {:.1f} s", end_s);
    case WalkEnd::kNoProgress:
      return fmt::format("the robot came no nearer to its next point, until {:.1f} s", end_s);
    case WalkEnd::kTimeLimit:
      return fmt::format("max_duration ended it at {:.1f} s, before the end of the route", end_s);
    case WalkEnd::kUnstablePhysics:
      return fmt::format("the simulated physics became unstable at {:.1f} s", end_s);
    case WalkEnd::kRunning:
      return fmt::format("it was stopped at {:.1f} s, before the end of the route", end_s);
  }
  return "";
}

/// How a record's simulation ended; older results have no `end`.
WalkOutcome walk_in(const Json& robot) {
  WalkOutcome walk;
  walk.end = value_in(robot, "fell", false) ? WalkEnd::kFell : WalkEnd::kRouteDone;
  for (const WalkEnd end : kEnds) {
    if (value_in(robot, "end", "") == name_of(end)) walk.end = end;
  }
  walk.touched_wall = value_in(robot, "touched_wall", false);
  walk.wall_contact_fraction = value_in(robot, "wall_contact_fraction", 0.0);
  return walk;
}

void withdraw_success(Json& scores) {
  scores[kSuccessKey] = false;
  if (scores.contains(kStrictSuccessKey)) scores[kStrictSuccessKey] = false;
}

bool has_robot(const Json& scores) {
  return scores.is_object() && scores.contains("robot") && scores["robot"].is_object();
}

}  // namespace

std::optional<std::string> invalid_reason(const WalkOutcome& walk, double end_s) {
  if (std::string reason = reason_of(walk.end, end_s); !reason.empty()) return reason;
  if (walk.wall_contact_fraction <= kMaxWallContact) return std::nullopt;
  return fmt::format("the robot touched a wall for {:.0f} % of the time walked",
                     100.0 * walk.wall_contact_fraction);
}

std::optional<std::string> invalid_reason(const Json& scores) {
  if (!scores.is_object()) return std::nullopt;
  if (value_in(scores, "interrupted", false)) return "it was interrupted";
  if (!has_robot(scores)) return std::nullopt;
  return invalid_reason(walk_in(scores["robot"]), value_in(scores, "simulated_s", 0.0));
}

void mark_validity(Json& scores) {
  const auto reason = invalid_reason(scores);
  if (has_robot(scores)) {
    scores["robot"]["valid"] = !reason;
    scores["robot"]["invalid_reason"] = reason ? Json(*reason) : Json();
  }
  if (!reason || !scores.contains("estimators")) return;
  for (auto& [name, estimator] : scores["estimators"].items()) {
    if (!estimator.is_object()) continue;
    withdraw_success(estimator);
    if (estimator.contains("optimized")) withdraw_success(estimator["optimized"]);
  }
}

bool is_valid_run(const RunRecord& run) { return !invalid_reason(run.scores); }

std::vector<InvalidRun> invalid_runs(std::span<const RunRecord> runs) {
  std::vector<InvalidRun> invalid;
  for (const RunRecord& run : runs) {
    if (auto reason = invalid_reason(run.scores)) invalid.push_back({run.seed, std::move(*reason)});
  }
  return invalid;
}

Json invalid_json(std::span<const RunRecord> runs) {
  return json_array(invalid_runs(runs), [](const InvalidRun& run) {
    return Json{{"seed", run.seed}, {"reason", run.reason}};
  });
}

std::string left_out_text(std::span<const RunRecord> runs) {
  std::vector<std::string> reasons;
  for (const auto& [seed, reason] : invalid_runs(runs)) {
    reasons.push_back(fmt::format("seed {} ({})", seed, reason));
  }
  if (reasons.empty()) return "";
  return fmt::format("{} of {} runs are invalid and left out: {}", reasons.size(), runs.size(),
                     fmt::join(reasons, ", "));
}

}  // namespace aims
