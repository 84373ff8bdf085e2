// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <bitset>
#include <optional>
#include <vector>

#include "core/measurements.hpp"

namespace aims {

/// How many clouds are a turn of a spinning LiDAR whose driver sends it in parts.
struct TurnParts {
  int count = 1;      ///< 1: each cloud is a scan
  double step = 0.0;  ///< from the middle of a part to that of the next, about z [rad]
};

/// Finds out from clouds in their order whether they are parts of a turn: each covers some
/// azimuths, and the next one those beside them, always on the same side.
class TurnPartFinder {
 public:
  /// Begins the next cloud.
  void begin();
  /// Adds a return of it, in the axes of the LiDAR.
  void add(const Eigen::Vector3d& position);

  TurnParts find() const;

  /// The largest part of the turn in which a cloud has no returns, in the median of the clouds [-].
  double blind_part() const;

 private:
  static constexpr std::size_t kBins = 72;
  struct Cloud {
    std::bitset<kBins> seen;  ///< azimuths
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    int points = 0;
  };
  std::vector<Cloud> clouds_;
};

/// Joins clouds that are parts of a turn. A turn begins with any part; one that is not whole, as
/// where parts were lost, is left out.
class TurnJoiner {
 public:
  /// `period`: nominal time of a part.
  TurnJoiner(const TurnParts& parts, Duration period);

  /// Adds the next part; returns the turn that it completes.
  std::optional<LidarScan> add(const LidarScan& part);

 private:
  void begin(const LidarScan& part);

  TurnParts parts_;
  Duration longest_;  ///< a turn
  LidarScan turn_;
  bool begun_ = false;
  double middle_ = 0.0;  ///< of the last part [rad]
  double turned_ = 0.0;  ///< from the middle of the first part to that of the last [rad]
};

}  // namespace aims
