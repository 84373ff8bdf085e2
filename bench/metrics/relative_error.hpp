// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "bench/metrics/association.hpp"

namespace aims {

/// Which pairs of poses the relative error compares.
struct RpeOptions {
  double delta = 1.0;            ///< path length between the two poses [m]
  bool all_pairs = false;        ///< from every pose, not only from the end of the last pair
  bool pairs_from_truth = true;  ///< path measured along the truth (evo's default: the estimate)
};

/// Relative pose error over one path length (evo: RPE with delta in metres).
struct RpeScore {
  double delta = 0.0;                        ///< [m]
  int pairs = 0;                             ///< compared; 0: the path is too short
  std::optional<double> translation_rmse_m;  ///< of |trans(E)|
  std::optional<double> rotation_rmse_rad;   ///< of the rotation angle of E
};

/// Indices (from, to) of poses about `delta` of path apart, by the rules of evo: consecutive pairs
/// end at the first pose at or beyond delta, and the pair from the very first pose is left out;
/// with all pairs each pose takes the later one nearest to delta, if within a tenth of it.
std::vector<std::pair<std::size_t, std::size_t>> pairs_over_path(
    std::span<const Eigen::Vector3d> positions, const RpeOptions& options);

/// E = (Q_i^-1 Q_j)^-1 (P_i^-1 P_j) with truth Q and estimate P; needs no alignment.
RpeScore relative_pose_error(std::span<const PosePair> pairs, const RpeOptions& options);

}  // namespace aims
