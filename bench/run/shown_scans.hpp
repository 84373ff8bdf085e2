// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "bench/run/sequence_file.hpp"
#include "core/error.hpp"
#include "core/files/csv.hpp"
#include "core/trajectory.hpp"

namespace aims {

/// Scans that are kept to look at: no more than so many of a sequence, and of each so many returns.
inline constexpr std::size_t kMostShownScans = 240;
inline constexpr std::size_t kMostShownReturns = 400;
/// They lie at least so far apart.
inline constexpr Duration kShownScanSpacing = kSecond;

/// A return in the body frame [m] at the end of its scan; the motion since it was fired is undone
/// with the truth.
struct ShownReturn {
  Eigen::Vector3f p_body = Eigen::Vector3f::Zero();
  float intensity = 0.0F;  ///< [0, 1]
};

struct ShownScan {
  Time stamp = 0;           ///< end of the scan
  std::size_t returns = 0;  ///< of the whole scan
  std::vector<ShownReturn> shown;
};

/// Indices of at most `most` of `count` returns, one in each of as many equal parts, at changing
/// places in them: an even step would hit the same rings again and again.
std::vector<std::size_t> spread_indices(std::size_t count, std::size_t most);

/// The returns of a scan that are kept. `truth`: T_world_body at the physics rate; a return fired
/// outside it is left out.
ShownScan shown_scan(const LidarScan& scan, const Trajectory& truth, const Pose& T_body_lidar);

/// Scans of a sequence at even distances in time.
Result<std::vector<ShownScan>> shown_scans(const SequenceReader& reader, const Trajectory& truth);

/// A row per return: stamp_s, returns, x, y, z [m], intensity.
CsvTable shown_scans_table(std::span<const ShownScan> scans);

}  // namespace aims
