// SPDX-License-Identifier: BSD-3-Clause
#include "bench/metrics/path_error.hpp"

#include <algorithm>
#include <numbers>

namespace aims {
namespace {

constexpr Duration kPieceSpacing = kSecond;

/// True length of the path up to each pair [m].
std::vector<double> path_to(std::span<const PosePair> pairs) {
  std::vector<double> path(pairs.size(), 0.0);
  for (std::size_t i = 1; i < pairs.size(); ++i) {
    path[i] = path[i - 1] + (pairs[i].truth.translation - pairs[i - 1].truth.translation).norm();
  }
  return path;
}

/// Indices of the pairs at which pieces start.
std::vector<std::size_t> piece_starts(std::span<const PosePair> pairs) {
  std::vector<std::size_t> starts;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const bool next =
        starts.empty() || pairs[i].stamp - pairs[starts.back()].stamp >= kPieceSpacing;
    if (next) starts.push_back(i);
  }
  return starts;
}

/// Sums over pieces.
struct PieceSums {
  int pieces = 0;
  double translation = 0.0;  ///< over length [-]
  double rotation = 0.0;     ///< over length [rad/m]

  void add(const PosePair& from, const PosePair& to, double length) {
    const Pose true_motion = from.truth.inverse() * to.truth;
    const Pose estimated_motion = from.estimate.inverse() * to.estimate;
    const Pose error = estimated_motion.inverse() * true_motion;
    ++pieces;
    translation += error.translation.norm() / length;
    rotation += so3_log(error.rotation).norm() / length;
  }

  PathError mean(double length) const {
    PathError error{length, pieces, std::nullopt, std::nullopt};
    if (pieces == 0) return error;
    error.translation_percent = 100.0 * translation / pieces;
    error.rotation_deg_per_m = 180.0 / std::numbers::pi * rotation / pieces;
    return error;
  }
};

}  // namespace

PathErrors path_errors(std::span<const PosePair> pairs) {
  PathErrors errors;
  const std::vector<double> path = path_to(pairs);
  const std::vector<std::size_t> starts = piece_starts(pairs);
  PieceSums all;
  for (const double length : kPathErrorLengths) {
    PieceSums sums;
    for (const std::size_t start : starts) {
      const auto end = std::upper_bound(path.begin(), path.end(), path[start] + length);
      if (end == path.end()) break;
      const PosePair& last = pairs[static_cast<std::size_t>(end - path.begin())];
      sums.add(pairs[start], last, length);
      all.add(pairs[start], last, length);
    }
    errors.lengths.push_back(sums.mean(length));
  }
  errors.all = all.mean(0.0);
  return errors;
}

}  // namespace aims
