// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "bench/metrics/association.hpp"

namespace aims {

/// Relative error over pieces of the path of one length, in the units of KITTI.
struct PathError {
  double length_m = 0.0;
  int pieces = 0;                             ///< 0: the path is too short
  std::optional<double> translation_percent;  ///< of the length
  std::optional<double> rotation_deg_per_m;
};

/// Means over the pieces of each length, and over all pieces of all lengths.
struct PathErrors {
  std::vector<PathError> lengths;
  PathError all;  ///< its length is 0
};

/// Lengths of the pieces [m].
inline constexpr double kPathErrorLengths[] = {5.0, 10.0, 20.0, 50.0, 100.0};

/// As the development kit of KITTI odometry (Geiger et al. 2012), with lengths for a walk: a piece
/// starts every second (there every tenth frame of 10 Hz) and ends at the first pose at which the
/// true path is more than the length further. E = (P_i^-1 P_j)^-1 (Q_i^-1 Q_j), estimate P and
/// truth Q; |trans(E)| and its rotation angle are divided by the length. Needs no alignment.
PathErrors path_errors(std::span<const PosePair> pairs);

}  // namespace aims
