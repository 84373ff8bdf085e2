// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/estimate/estimate.hpp"
#include "bench/estimate/lidar_odometry.hpp"
#include "bench/estimate/rotation_check.hpp"
#include "core/error.hpp"
#include "core/measurements.hpp"
#include "recordings/stream/recording_reader.hpp"

namespace aims {

/// Which scans LiDAR odometry runs on.
enum class WatchedScans {
  kAll,   ///< of the first three minutes
  kTurns  ///< 20 s of those during which the gyro turns, of the whole recording
};

/// Collects what LiDAR odometry without IMU and the gyro of a recording say of the rotations of the
/// body.
class RotationEvidence {
 public:
  /// Nothing where the recording has no IMU or no LiDAR.
  static std::optional<RotationEvidence> create(const RecordingSetup& setup, WatchedScans watched);

  void consume(std::span<const Delivery> deliveries);
  /// Call once, after the last delivery.
  void finish();

  /// By rotations over intervals of half a second in which the body turns.
  MountCheck mount() const;
  RateCheck rates() const;

  /// Scans that kAll watches.
  static constexpr Duration kLongest = 180 * kSecond;

 private:
  RotationEvidence(const SensorRig& rig, WatchedScans watched) : rig_(rig), watched_(watched) {}
  void take(const ImuSample& sample);
  void take(const LidarScan& scan);
  bool is_wanted(const LidarScan& scan);
  bool is_turning() const;
  void close();
  Duration half_scan() const;
  std::vector<ImuSample> seen_by_scans() const;

  SensorRig rig_;
  WatchedScans watched_;
  std::optional<LidarOdometry> odometry_;                  ///< of the present turn
  std::vector<Trajectory> turns_;                          ///< of the LiDAR odometry
  std::vector<ImuSample> samples_;                         ///< of turns, and the last ones
  std::size_t kept_ = 0;                                   ///< samples of turns
  Eigen::Vector3d first_force_ = Eigen::Vector3d::Zero();  ///< sum over the first second, IMU axes
  std::optional<Time> first_sample_;
  std::vector<Duration> scan_times_;
  std::optional<Time> first_scan_;
  std::optional<Time> last_turning_;
};

/// The check of mount, gyro and clocks for the first three minutes of a recording, in words, with
/// what each axis showed and the line that corrects mount or clock. Errors as of `estimate`.
Result<std::vector<std::string>> mount_report(const EstimateConfig& config,
                                              const EstimateOptions& options);

/// A warning where rotations of LiDAR odometry contradict the gyro or the mount.
std::optional<ReadingWarning> warning_of(const RotationEvidence& evidence, const Pose& T_imu_lidar);

}  // namespace aims
