// SPDX-License-Identifier: BSD-3-Clause
#include "bench/metrics/localizability_scores.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace aims {
namespace {

template <class Stamped>
std::vector<Time> stamps_of(std::span<const Stamped> values) {
  std::vector<Time> stamps;
  stamps.reserve(values.size());
  for (const Stamped& each : values) stamps.push_back(each.stamp);
  return stamps;
}

/// Score of the scans with fewer equivalent returns than the limit.
WeakAxisScore score_below(std::span<const WeakAxisError> errors, std::string level, double limit) {
  WeakAxisScore score;
  score.level = std::move(level);
  double squared_error = 0.0;
  double squared_bound = 0.0;
  double squared_ratio = 0.0;
  int stated = 0;
  for (const WeakAxisError& each : errors) {
    if (!(each.equivalent_returns < limit)) continue;
    ++score.scans;
    squared_error += each.error_m * each.error_m;
    squared_bound += each.bound_m * each.bound_m;
    if (!each.variance || !(*each.variance > 0.0)) continue;
    ++stated;
    squared_ratio += each.error_m * each.error_m / *each.variance;
  }
  if (score.scans == 0) return score;
  score.error_rms_m = std::sqrt(squared_error / score.scans);
  score.bound_rms_m = std::sqrt(squared_bound / score.scans);
  if (squared_error > 0.0) score.efficiency = std::sqrt(squared_bound / squared_error);
  if (stated > 0) score.nees = squared_ratio / stated;
  return score;
}

}  // namespace

std::optional<std::size_t> nearest_stamp(std::span<const Time> stamps, Time stamp,
                                         Duration tolerance) {
  const auto after = std::lower_bound(stamps.begin(), stamps.end(), stamp);
  auto best = after;
  if (after == stamps.end() ||
      (after != stamps.begin() && stamp - *std::prev(after) <= *after - stamp)) {
    if (after == stamps.begin()) return std::nullopt;
    best = std::prev(after);
  }
  if (std::abs(*best - stamp) > tolerance) return std::nullopt;
  return static_cast<std::size_t>(best - stamps.begin());
}

std::vector<WeakAxisError> weak_axis_errors(std::span<const PosePair> pairs,
                                            std::span<const StatedCovariance> stated,
                                            std::span<const Localizability> scans,
                                            std::span<const PosteriorBound> bounds,
                                            Duration tolerance) {
  assert(scans.size() == bounds.size());
  const std::vector<Time> pair_stamps = stamps_of(pairs);
  const std::vector<Time> stated_stamps = stamps_of(stated);
  std::vector<WeakAxisError> errors;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const auto found = nearest_stamp(pair_stamps, scans[i].stamp, tolerance);
    if (!found) continue;
    const PosePair& pair = pairs[*found];
    const Eigen::Vector3d& axis = scans[i].weak_axis_in_world;
    WeakAxisError error;
    error.stamp = scans[i].stamp;
    error.equivalent_returns = scans[i].equivalent_returns;
    error.error_m = axis.dot(pair.estimate.translation - pair.truth.translation);
    error.bound_m = bound_along(bounds[i], axis);
    if (const auto match = nearest_stamp(stated_stamps, scans[i].stamp, tolerance)) {
      const Eigen::Vector3d& in_body = scans[i].weak_axis_in_body;
      error.variance = in_body.dot(stated[*match].position_in_body * in_body);
    }
    errors.push_back(error);
  }
  return errors;
}

std::vector<WeakAxisScore> weak_axis_scores(std::span<const WeakAxisError> errors) {
  std::vector<WeakAxisScore> scores;
  scores.push_back(score_below(errors, "all", std::numeric_limits<double>::infinity()));
  for (const DegeneracyLevel& level : kDegeneracyLevels) {
    scores.push_back(score_below(errors, std::string(level.name), level.equivalent_returns));
  }
  return scores;
}

}  // namespace aims
