// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scoring/score_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace aims {
namespace {

/// Milliradians of an angle [rad].
Json mrad_json(const std::optional<double>& angle) {
  return angle ? json_of(1e3 * *angle) : Json();
}

Json segments_by_name(const Scores& scores, std::optional<double> SegmentDistance::*member) {
  Json json = Json::object();
  for (const SegmentDistance& distance : scores.segments) {
    json[distance.segment.name] = json_of(distance.*member);
  }
  return json;
}

/// M_list of each segment and, as "all", of their sum.
Json m_list_json(const Scores& scores) {
  Json json = segments_by_name(scores, &SegmentDistance::percent);
  json["all"] = json_of(scores.m_list_percent);
  return json;
}

Json control_points_json(const Scores& scores) {
  return {{"points", scores.control_points->points},
          {"reached", scores.control_points->reached},
          {"score", scores.control_points->score},
          {"score2023", scores.control_points->score_2023}};
}

Json ape_json(const Scores& scores) {
  return {{"mean", json_of(scores.ape_yaw, &AbsoluteErrorStatistics::mean_m)},
          {"median", json_of(scores.ape_yaw, &AbsoluteErrorStatistics::median_m)},
          {"std", json_of(scores.ape_yaw, &AbsoluteErrorStatistics::std_m)},
          {"max", json_of(scores.ape_yaw, &AbsoluteErrorStatistics::max_m)}};
}

/// By length, "5m", and over all pieces of all lengths.
Json path_errors_json(const Scores& scores, std::optional<double> PathError::*member) {
  Json json = Json::object();
  for (const PathError& each : scores.path_errors.lengths) {
    json[std::to_string(std::lround(each.length_m)) + "m"] = json_of(each.*member);
  }
  json["all"] = json_of(scores.path_errors.all.*member);
  return json;
}

const RpeScore* rpe_over(const Scores& scores, double delta) {
  const auto found = std::ranges::find(scores.rpe, delta, &RpeScore::delta);
  return found == scores.rpe.end() ? nullptr : &*found;
}

template <int kDelta>
Json rpe_json(const Scores& scores) {
  const RpeScore* rpe = rpe_over(scores, kDelta);
  return {{"translation_m", json_of(rpe->translation_rmse_m)},
          {"rotation_rad", json_of(rpe->rotation_rmse_rad)}};
}

template <int kDelta>
bool has_rpe(const Scores& scores) {
  return rpe_over(scores, kDelta) != nullptr;
}

Json axis_json(const AxisError& error, bool has_attitude) {
  return {{"longitudinal", error.longitudinal_m},
          {"lateral", error.lateral_m},
          {"vertical", error.vertical_m},
          {"heading_rad", has_attitude ? Json(error.heading_rad) : Json()},
          {"tilt_rad", has_attitude ? Json(error.tilt_rad) : Json()}};
}

Json drift_json(const Scores& scores) {
  const std::optional<DriftSummary>& drift = scores.drift;
  if (!drift) return {};
  const bool attitude = drift->has_attitude;
  return {{"rmse", axis_json(drift->rmse, attitude)},
          {"max", axis_json(drift->max, attitude)},
          {"end", axis_json(drift->end, attitude)}};
}

bool has_sim3(const Scores& s) { return s.sim3_scale.has_value(); }
bool has_control_points(const Scores& s) { return s.control_points.has_value(); }

constexpr Better kSmall = Better::kSmaller;
constexpr Better kLarge = Better::kLarger;
constexpr Better kOpen = Better::kNeither;

// clang-format off
constexpr std::array kScores = {
    Score{"success", "within 5 %", "-", 0, kLarge, 0,
          [](const Scores& s) { return s.judged ? Json(s.success) : Json(); }},
    Score{"success_1_percent", "within 1 %", "-", 0, kLarge, 0,
          [](const Scores& s) { return s.judged ? Json(s.success_1_percent) : Json(); }},
    Score{"diverged_reason", "", "", 0, kOpen, 0,
          [](const Scores& s) { return Json(name_of(s.failure_reason)); }},
    Score{"diverged_at_s", "", "s", 1, kLarge, 0,
          [](const Scores& s) { return s.diverged_at ? Json(to_seconds(*s.diverged_at)) : Json(); }},
    Score{"partial", "", "", 0, kOpen, 0, [](const Scores& s) { return Json(s.partial); }},
    Score{"coverage", "tracked", "-", 2, kLarge, 0, [](const Scores& s) { return Json(s.coverage); }},
    Score{"m_list_percent", "M_list", "%", 3, kSmall, 0.02, m_list_json},
    Score{"m_list_signed_percent", "", "%", 3, kOpen, 0,
          [](const Scores& s) { return segments_by_name(s, &SegmentDistance::signed_percent); }},
    Score{"m_end_m", "M_end", "m", 3, kSmall, 0.01,
          [](const Scores& s) { return json_of(s.m_end, &EndError::norm_m); }},
    Score{"m_end_xy_m", "", "m", 3, kSmall, 0,
          [](const Scores& s) { return json_of(s.m_end, &EndError::xy_m); }},
    Score{"m_end_z_m", "", "m", 3, kSmall, 0,
          [](const Scores& s) { return json_of(s.m_end, &EndError::z_m); }},
    Score{"start_to_end_m", "", "m", 3, kOpen, 0,
          [](const Scores& s) { return json_of(s.start_to_end_m); }},
    Score{"control_points.points", "", "-", 0, kLarge},
    Score{"control_points.reached", "", "-", 0, kLarge},
    Score{"control_points", "control points", "%", 1, kLarge, 0, control_points_json,
          has_control_points},
    Score{"ate_yaw_m", "ATE yaw", "m", 3, kSmall, 0.01,
          [](const Scores& s) { return json_of(s.ate_yaw_m); }},
    Score{"heading_error_mrad", "heading", "mrad", 1, kSmall, 1.0,
          [](const Scores& s) { return mrad_json(s.heading_error_rad); }},
    Score{"heading_offset_mrad", "", "mrad", 1, kOpen, 0,
          [](const Scores& s) { return mrad_json(s.heading_offset_rad); }},
    Score{"ape_yaw_m", "", "m", 3, kSmall, 0, ape_json},
    Score{"ate_m", "ATE start", "m", 3, kSmall, 0.01,
          [](const Scores& s) { return json_of(s.ate_m); }},
    Score{"ate_se3_m", "ATE SE(3)", "m", 3, kSmall, 0,
          [](const Scores& s) { return json_of(s.ate_se3_m); }},
    Score{"ate_se3_degenerate", "", "", 0, kOpen, 0,
          [](const Scores& s) { return Json(s.ate_se3_m.has_value() && s.se3_spread != PositionSpread::kFull); }},
    Score{"ate_sim3_m", "ATE Sim(3)", "m", 3, kSmall, 0,
          [](const Scores& s) { return json_of(s.ate_sim3_m); }, has_sim3},
    Score{"sim3_scale", "", "-", 4, kOpen, 0,
          [](const Scores& s) { return json_of(s.sim3_scale); }, has_sim3},
    Score{"max_error_m", "", "m", 3, kSmall, 0, [](const Scores& s) { return json_of(s.max_error_m); }},
    Score{"max_error_z_m", "max |z|", "m", 3, kSmall, 0.01,
          [](const Scores& s) { return json_of(s.max_abs_z_error_m); }},
    Score{"path_error_percent", "path error", "%", 3, kSmall, 0,
          [](const Scores& s) { return path_errors_json(s, &PathError::translation_percent); }},
    Score{"path_error_deg_per_m", "path error", "deg/m", 3, kSmall, 0,
          [](const Scores& s) { return path_errors_json(s, &PathError::rotation_deg_per_m); }},
    Score{"rpe_1m.rotation_rad", "", "rad"},
    Score{"rpe_1m", "RPE 1 m", "m", 3, kSmall, 0, rpe_json<1>, has_rpe<1>},
    Score{"rpe_10m.rotation_rad", "", "rad"},
    Score{"rpe_10m", "RPE 10 m", "m", 3, kSmall, 0, rpe_json<10>, has_rpe<10>},
    // At the end with a sign, of which neither end is better.
    Score{"drift_m.end.heading_rad", "", "rad", 3, kOpen},
    Score{"drift_m.end.tilt_rad", "", "rad", 3, kOpen},
    Score{"drift_m.end", "", "m", 3, kOpen},
    Score{"drift_m.*.heading_rad", "", "rad"},
    Score{"drift_m.*.tilt_rad", "", "rad"},
    Score{"drift_m", "", "m", 3, kSmall, 0, drift_json},
    Score{"weak_axis.*.efficiency", "", "-", 2, kLarge},
    Score{"weak_axis.*.error_rms_m", "", "m", 2, kOpen},
    Score{"weak_axis.*.bound_rms_m", "", "m", 2, kOpen},
    Score{"weak_axis", "NEES weak axis", "-", 2, kOpen},
    Score{"time_per_scan_ms", "wall", "ms", 2},
    Score{"cpu_per_scan_ms", "CPU", "ms", 2},
    Score{"poses", "", "-", 0, kLarge},
    Score{"poses_invalid", "", "-", 0},
    Score{"counts", "", "-", 0, kOpen},  // what the data and the machine decide
    Score{"health.healthy_s", "", "s", 1, kLarge},
    Score{"health", "", "s", 1},
};
// clang-format on

/// The first part of a dotted key, which is taken off.
std::string_view take_part(std::string_view& key) {
  const std::string_view part = key.substr(0, key.find('.'));
  key.remove_prefix(std::min(part.size() + 1, key.size()));
  return part;
}

/// Whether `key` is the number of that entry or below it.
bool is_at(std::string_view entry, std::string_view key) {
  while (!entry.empty()) {
    const std::string_view part = take_part(entry);
    if (const auto own = take_part(key); part != own && part != "*") return false;
  }
  return true;
}

/// The entry of that key or of the closest one above it; the end where there is none.
const Score* listed(std::string_view key) {
  constexpr std::string_view kOptimized = kOptimizedPrefix;
  if (key.starts_with(kOptimized)) key.remove_prefix(kOptimized.size());
  return std::ranges::find_if(kScores, [&](const Score& each) { return is_at(each.key, key); });
}

/// The entry for a number of that key.
Score number(const char* key) {
  Score score = score_at(key);
  score.key = key;
  return score;
}

}  // namespace

std::span<const Score> score_list() { return kScores; }

const Score& score_at(std::string_view key) { return *listed(key); }

Better better_of(std::string_view key) {
  const auto* const score = listed(key);
  return score == kScores.end() ? Better::kSmaller : score->better;
}

std::string_view unit_of(std::string_view key) {
  const auto* const score = listed(key);
  return score == kScores.end() || score->unit == "-" ? "" : score->unit;
}

std::string title_with_unit(const Score& score) {
  return fmt::format("{} [{}]", score.title, score.unit);
}

const std::array<Score, kHeadlineCount>& headline_scores() {
  static const std::array<Score, kHeadlineCount> scores = {
      number("ate_yaw_m"),          number("ate_m"),   number("heading_error_mrad"),
      number("m_list_percent.all"), number("m_end_m"), number("max_error_z_m")};
  return scores;
}

const std::array<Score, kSuccessCount>& success_scores() {
  static const std::array<Score, kSuccessCount> scores = {number("success"),
                                                          number("success_1_percent")};
  return scores;
}

bool is_timing(std::string_view score_key) {
  return score_key.starts_with("time_per_scan_ms") || score_key.starts_with("cpu_per_scan_ms");
}

Json json_of(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? Json(*value) : Json();
}

Json scores_json(const Scores& scores) {
  Json json;
  for (const Score& each : kScores) {
    if (each.value == nullptr || (each.present != nullptr && !each.present(scores))) continue;
    json[each.key] = each.value(scores);
  }
  return json;
}

}  // namespace aims
