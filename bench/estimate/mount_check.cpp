// SPDX-License-Identifier: BSD-3-Clause
#include "bench/estimate/mount_check.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "bench/estimate/stream.hpp"
#include "core/text.hpp"

namespace aims {
namespace {

constexpr double kClockOffset = 0.02;  ///< that counts: half of what scans of 10 Hz show [s]

std::vector<std::string> words(const RateCheck& check, const RecordingConfig& config) {
  if (check.is_wrong_unit()) {
    const bool degrees = check.scale > 1.0;
    return {fmt::format(
        "UNIT OF THE GYRO: it turns {:.3g} times as fast as LiDAR odometry: {}", check.scale,
        degrees ? "it is in deg/s: set recording.gyro_unit=deg/s (of a table: gyro_unit: deg/s)"
                : "it is converted to rad/s twice")};
  }
  if (!check.clock) {
    return {"clock of the LiDAR: not checked: the turns of the body do not show an offset"};
  }
  const double offset = check.clock->seconds;
  if (std::abs(offset) < kClockOffset) {
    return {fmt::format("clock of the LiDAR: within {:.0f} ms of the IMU's", 1e3 * kClockOffset)};
  }
  return {
      fmt::format("CLOCK OF THE LIDAR: stamped {:.0f} ms too {} against the IMU (correlation of "
                  "the turn rates {:.2f})",
                  1e3 * std::abs(offset), offset > 0.0 ? "late" : "early",
                  check.clock->correlation),
      fmt::format("  to try it: --set recording.lidar_delay={:.3f}", config.lidar_delay + offset)};
}

/// What the turns about each axis say of it.
std::string axes_text(const MountCheck& check) {
  std::vector<std::string> axes;
  for (std::size_t i = 0; i < 3; ++i) {
    const AxisCheck& axis = check.axes[i];
    axes.push_back(axis.observable()
                       ? fmt::format("{}: {} rotations, scale {}, correlation {}", "xyz"[i],
                                     axis.intervals, decimal_text(axis.scale, 2),
                                     decimal_text(axis.correlation, 2))
                       : fmt::format("{}: not checked, {} rotations", "xyz"[i], axis.intervals));
  }
  return fmt::format("gyro against LiDAR odometry, by axes of the IMU: {}", fmt::join(axes, "; "));
}

std::string verdict_text(const MountCheck& check) {
  if (check.contradicts) {
    return fmt::format(
        "{}: LiDAR odometry and gyro contradict it over {} rotations (residual "
        "{:.3f}; {:.3f} if {})",
        check.correctable ? "MOUNT OF THE LIDAR" : "GYRO", check.intervals, check.given_residual,
        check.best_residual, check.cause);
  }
  return fmt::format(
      "mount of the LiDAR: no contradiction between LiDAR odometry and gyro over {} "
      "rotations (residual {:.3f}){}",
      check.intervals, check.given_residual,
      check.one_axis ? ", all about one axis: the mount's angle about that axis is "
                       "not checked"
                     : "");
}

std::string correction_text(const MountCheck& check, const Pose& T_imu_lidar) {
  Eigen::Quaterniond q = check.R_imu_lidar;
  q.coeffs() = (q.coeffs().array().abs() < 1e-9).select(0.0, q.coeffs());
  const Eigen::Vector3d t = T_imu_lidar.translation.array() + 0.0;  // no negative zeros
  return fmt::format(
      "--set recording.T_imu_lidar.quaternion_xyzw=[{:.6g},{:.6g},{:.6g},{:.6g}] "
      "--set recording.T_imu_lidar.translation=[{:.6g},{:.6g},{:.6g}]",
      q.x(), q.y(), q.z(), q.w(), t.x(), t.y(), t.z());
}

std::vector<std::string> words(const MountCheck& check, const Pose& T_imu_lidar) {
  if (!check.checked()) {
    return {
        fmt::format("mount of the LiDAR and gyro: not checked: the body turns in {} intervals "
                    "of 0.5 s, too few",
                    check.intervals)};
  }
  std::vector<std::string> lines = {axes_text(check), verdict_text(check)};
  if (check.correctable) lines.push_back("  to try it: " + correction_text(check, T_imu_lidar));
  return lines;
}

}  // namespace

Result<std::vector<std::string>> mount_report(const EstimateConfig& config,
                                              const EstimateOptions& options) {
  auto reader = RecordingReader::open(options.bag, config.recording,
                                      {.recover = options.recover, .with = options.with});
  if (!reader) return tl::unexpected(reader.error());
  auto evidence = RotationEvidence::create(reader->setup(), WatchedScans::kAll);
  if (!evidence) {
    return std::vector<std::string>{"mount of the LiDAR: not checked: needs an IMU and a LiDAR"};
  }
  std::vector<Delivery> batch;
  for (bool more = true; more && reader->position() < RotationEvidence::kLongest;) {
    batch.clear();
    const auto next = reader->advance(kStreamBatch, batch);
    more = next && *next;
    evidence->consume(batch);
  }
  evidence->finish();
  const RateCheck rates = evidence->rates();
  std::vector<std::string> lines = words(rates, config.recording);
  if (rates.is_wrong_unit()) return lines;
  const Pose& T_imu_lidar = reader->setup().rig.T_body_lidar;
  for (std::string& line : words(evidence->mount(), T_imu_lidar)) lines.push_back(std::move(line));
  return lines;
}

std::optional<ReadingWarning> warning_of(const RotationEvidence& evidence,
                                         const Pose& T_imu_lidar) {
  const MountCheck check = evidence.mount();
  if (!check.contradicts) return std::nullopt;
  const std::string advice =
      check.correctable ? ": try " + correction_text(check, T_imu_lidar) : std::string();
  return ReadingWarning{
      "LiDAR odometry contradicts the gyro or the mount",
      fmt::format("LiDAR odometry and gyro contradict each other over {} rotations: it seems that "
                  "{}{} (aims info --mount)",
                  check.intervals, check.cause, advice)};
}

}  // namespace aims
