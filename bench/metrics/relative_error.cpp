// SPDX-License-Identifier: BSD-3-Clause
#include "bench/metrics/relative_error.hpp"

#include <algorithm>
#include <cmath>

namespace aims {
namespace {

using IndexPairs = std::vector<std::pair<std::size_t, std::size_t>>;

IndexPairs consecutive_pairs(std::span<const Eigen::Vector3d> positions, double delta) {
  IndexPairs pairs;
  std::optional<std::size_t> previous;
  double path = 0.0;
  for (std::size_t i = 1; i < positions.size(); ++i) {
    path += (positions[i] - positions[i - 1]).norm();
    if (path < delta) continue;
    if (previous) pairs.emplace_back(*previous, i);
    previous = i;
    path = 0.0;
  }
  return pairs;
}

IndexPairs all_pairs(std::span<const Eigen::Vector3d> positions, double delta) {
  constexpr double kTolerance = 0.1;  // of delta
  std::vector<double> path(positions.size(), 0.0);
  for (std::size_t i = 1; i < positions.size(); ++i) {
    path[i] = path[i - 1] + (positions[i] - positions[i - 1]).norm();
  }
  IndexPairs pairs;
  for (std::size_t i = 0; i + 1 < positions.size(); ++i) {
    const auto first = path.begin() + static_cast<std::ptrdiff_t>(i) + 1;
    auto best = std::lower_bound(first, path.end(), path[i] + delta);
    const auto off = [&](auto at) { return std::abs(*at - path[i] - delta); };
    if (best == path.end() || (best != first && off(std::prev(best)) <= off(best))) --best;
    // The first of equals, as a search for the smallest from the left finds it.
    best = std::lower_bound(first, path.end(), *best);
    if (off(best) > delta * kTolerance) continue;
    pairs.emplace_back(i, static_cast<std::size_t>(best - path.begin()));
  }
  return pairs;
}

}  // namespace

IndexPairs pairs_over_path(std::span<const Eigen::Vector3d> positions, const RpeOptions& options) {
  if (positions.size() < 2 || !(options.delta > 0.0)) return {};
  return options.all_pairs ? all_pairs(positions, options.delta)
                           : consecutive_pairs(positions, options.delta);
}

RpeScore relative_pose_error(std::span<const PosePair> pairs, const RpeOptions& options) {
  std::vector<Eigen::Vector3d> positions;
  for (const PosePair& each : pairs) {
    positions.push_back(options.pairs_from_truth ? each.truth.translation
                                                 : each.estimate.translation);
  }
  const IndexPairs index_pairs = pairs_over_path(positions, options);
  RpeScore score;
  score.delta = options.delta;
  score.pairs = static_cast<int>(index_pairs.size());
  if (index_pairs.empty()) return score;
  double translation = 0.0, rotation = 0.0;  // sums of squares
  for (const auto& [i, j] : index_pairs) {
    const Pose true_motion = pairs[i].truth.inverse() * pairs[j].truth;
    const Pose estimated_motion = pairs[i].estimate.inverse() * pairs[j].estimate;
    const Pose error = true_motion.inverse() * estimated_motion;
    const double moved = error.translation.norm(), turned = so3_log(error.rotation).norm();
    translation += moved * moved;
    rotation += turned * turned;
  }
  const auto count = static_cast<double>(index_pairs.size());
  score.translation_rmse_m = std::sqrt(translation / count);
  score.rotation_rmse_rad = std::sqrt(rotation / count);
  return score;
}

}  // namespace aims
