// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>

#include "estimator/aims/scan_diagnostics.hpp"
#include "estimator/filter/input_monitor.hpp"
#include "estimator/filter/kalman_update.hpp"
#include "estimator/interface/health.hpp"

namespace aims {

/// What an estimator draws on: what it does not use cannot be missing.
struct HealthSources {
  bool lidar = false;
  bool legs = false;
  bool imu = false;
};

/// What is judged of the present estimate.
struct HealthEstimate {
  Eigen::Vector3d position;     ///< odometry frame [m]
  double speed = 0.0;           ///< [m/s]
  double position_sigma = 0.0;  ///< stated, along the least certain axis [m]; NaN: none stated
  double soft_leg_sigma = 0.0;  ///< of the scale of legs on soft joints; on stiff ones 0 [-]
};

/// The same of a belief, whose position has the covariance `others` besides (odometry axes) [m^2].
HealthEstimate health_estimate(const Belief& belief,
                               const Eigen::Matrix3d& others = Eigen::Matrix3d::Zero());

/// Judges an estimate by what arrives and by how well the sources agree. It never sees the truth:
/// errors in which all sources agree stay unnoticed.
class HealthMonitor {
 public:
  /// Time between judgements.
  static constexpr Duration kInterval = 100 * kMillisecond;

  HealthMonitor(const HealthSources& sources, double gravity)
      : sources_(sources), gravity_(gravity) {}

  /// Difference between the velocity that the legs report, uncorrected, and that of the filter,
  /// base axes [m/s]. A learned scale would explain away what contradicts.
  void leg_residual(const Eigen::Vector3d& residual);
  /// The result of a scan, of which `points` were to be matched.
  void scan(const ScanDiagnostics& scan, std::size_t points);
  /// The filter refused a result that is not finite.
  void not_finite() { not_finite_ = true; }
  /// Neither IMU nor LiDAR measured for `duration` [s].
  void outage(double duration);
  /// The data contradict the calibration that the run started from.
  void calibration_contradicted() { calibration_contradicted_ = true; }

  /// State and reasons at `now` (arrival); `estimate` is empty before the estimate starts.
  HealthRow judge(Time now, const InputMonitor& inputs,
                  const std::optional<HealthEstimate>& estimate);

 private:
  struct Findings;
  void judge_inputs(Time now, const InputMonitor& inputs, Findings& findings) const;
  void judge_agreement(Findings& findings) const;
  void judge_estimate(const HealthEstimate& estimate, bool scans_hold_the_way, Findings& findings);
  bool lidar_corrects(Time now, const InputMonitor& inputs) const;

  HealthSources sources_;
  double gravity_;
  Eigen::Vector3d leg_residual_ = Eigen::Vector3d::Zero();  ///< moving average [m/s]
  double rotation_residual_ = 0.0;  ///< moving average, scans against prediction [rad]
  double position_residual_ = 0.0;  ///< likewise [m]
  double expected_rotation_ = 0.0;  ///< moving average, what the noise of the IMU makes [rad]
  double expected_position_ = 0.0;  ///< likewise [m]
  double weak_tilt_ = 0.0;          ///< likewise, of the planes towards the weakest axis [rad]
  double matched_ = 1.0;            ///< moving average of the fraction of matched points
  int scans_without_update_ = 0;    ///< in a row
  int weak_scans_ = 0;              ///< in a row, which leave an axis free
  double path_ = 0.0;               ///< [m]
  std::optional<Eigen::Vector3d> last_position_;
  bool calibration_contradicted_ = false;
  bool position_lost_ = false;
  bool not_finite_ = false;  ///< since the last judgement
};

/// Appends the row of the end of the stream, until which the one before holds.
void close_health(std::vector<HealthRow>& rows, HealthRow row);

}  // namespace aims
