// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/files/csv.hpp"
#include "core/measurements.hpp"
#include "core/trajectory.hpp"

namespace aims {

/// Scans that are kept to look at: no more than so many of a sequence, and of each so many returns.
inline constexpr std::size_t kMostShownScans = 240;
inline constexpr std::size_t kMostShownReturns = 400;
/// They lie at least so far apart.
inline constexpr Duration kShownScanSpacing = kSecond;

/// A return in the body frame [m] at the end of its scan; the motion since it was fired is undone.
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

/// The returns of a scan that are kept. `poses`: of the body in any fixed frame, by which the
/// motion is undone: the truth, or an estimate; a return fired outside them is left out.
ShownScan shown_scan(const LidarScan& scan, const Trajectory& poses, const Pose& T_body_lidar);

/// Keeps scans of a stream at even distances in time, which its length gives, until the poses are
/// known.
class ScanKeeper {
 public:
  explicit ScanKeeper(Duration length);

  /// Whether a scan that ends then would be kept.
  bool wants(const LidarScan& scan) const;
  /// Keeps the returns of a scan that are shown, if it is wanted.
  void add(const LidarScan& scan);
  /// What was kept, without scans of which no return has a pose.
  std::vector<ShownScan> shown(const Trajectory& poses, const Pose& T_body_lidar) const;

 private:
  struct Kept {
    LidarScan scan;  ///< with the shown returns alone
    std::size_t returns = 0;
  };
  Duration spacing_ = 0;
  std::optional<Time> next_;
  std::vector<Kept> kept_;
};

/// A row per return: stamp_s, returns, x, y, z [m], intensity.
CsvTable shown_scans_table(std::span<const ShownScan> scans);

}  // namespace aims
