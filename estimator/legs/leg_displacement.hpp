// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/measurements.hpp"
#include "core/time.hpp"
#include "estimator/aims/config.hpp"

namespace aims {

/// How far the leg odometry's base moved over an interval.
struct LegDisplacement {
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();  ///< base axes at its begin [m]
  Duration duration = 0;
  int packets = 0;  ///< stamped within the interval
};

/// Integrates the twists of leg odometry, linear and angular as reported, in order of stamp.
/// Between consecutive packets the base moves with the mean of their twists, however many were lost
/// in between; at the end of an interval, with the twist of its last packet. The reported pose is
/// not used: the packets at the two ends may be lost, and no packet is stamped at a scan's end.
class LegIntegrator {
 public:
  explicit LegIntegrator(const LegConfig& config);

  /// Begins a new interval; the last packet before it still serves as a neighbour.
  void begin(Time stamp);

  void add(const LegOdometrySample& sample);

  /// The displacement from the begin until `stamp`; empty when fewer than half of the packets that
  /// the interval should have had were added.
  std::optional<LegDisplacement> until(Time stamp) const;

 private:
  LegConfig config_;
  Time begin_ = 0;
  Time integrated_until_ = 0;
  int packets_ = 0;
  Pose T_begin_base_;
  std::optional<LegOdometrySample> last_;
};

}  // namespace aims
