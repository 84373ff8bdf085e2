// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <deque>
#include <optional>

#include "core/time.hpp"
#include "estimator/aims/directional_config.hpp"

namespace aims {

/// Where a scan by itself puts the body in the map.
struct LidarFix {
  Time stamp = 0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();    ///< odometry frame [m]
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of the returns' noise alone [m^2]
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();    ///< unit axes by column, odometry frame
  Eigen::Vector3d trusted = Eigen::Vector3d::Ones();     ///< along them: the scan sees it, [0, 1]
};

/// What one sample of the legs says of the body's motion.
struct LegMotionTold {
  Time stamp = 0;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< odometry axes [m/s]
  Eigen::Matrix3d noise = Eigen::Matrix3d::Zero();     ///< of its way, per time [m^2/s]
  bool firm = false;                                   ///< its standing feet agree with each other
};

/// Compares, axis by axis, how far scans and legs say that the body has moved within a window. A
/// difference that lasts costs one of them weight: the LiDAR along that axis as long as the legs
/// agree among themselves, the legs otherwise. Where either has nothing to say, nothing is judged,
/// and what has lasted goes on.
class Disagreement {
 public:
  explicit Disagreement(const DisagreementConfig& config) : config_(config) {}

  /// Takes a sample of the legs, in order of time.
  void add(const LegMotionTold& told);

  /// Judges the window that ends with `fix`. `leg_drift` is the covariance of an error of the legs'
  /// velocity that does not change within it, 3x3 in odometry axes [m^2/s^2].
  void judge(const LidarFix& fix, const Eigen::Matrix3d& leg_drift);

  /// Share of its weight that the LiDAR keeps along each axis of the last fix, in (0, 1].
  const Eigen::Vector3d& lidar_share() const { return lidar_share_; }

  /// By how much the covariance of the legs is to grow; at least 1.
  double leg_growth() const { return leg_growth_; }

 private:
  struct Instant {
    LidarFix fix;
    Eigen::Vector3d leg_way = Eigen::Vector3d::Zero();    ///< since the start [m]
    Eigen::Matrix3d leg_noise = Eigen::Matrix3d::Zero();  ///< of that way [m^2]
    double leg_gap = 0.0;                                 ///< time without legs since the start [s]
    double firm = 0.0;  ///< time with firm legs since the start [s]
  };

  void carry_streaks_over(const Eigen::Matrix3d& axes);
  Eigen::Vector3d excess(const Instant& from, const Instant& to,
                         const Eigen::Matrix3d& leg_drift) const;
  void blame(const Instant& from, const Instant& to, const Eigen::Vector3d& excess);

  DisagreementConfig config_;
  std::optional<LegMotionTold> last_leg_;
  Instant now_;
  std::deque<Instant> window_;
  Eigen::Vector3d streak_ = Eigen::Vector3d::Zero();  ///< how long it has lasted, by axis [s]
  Eigen::Vector3d lidar_share_ = Eigen::Vector3d::Ones();
  double leg_growth_ = 1.0;
};

}  // namespace aims
