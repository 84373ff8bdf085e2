// SPDX-License-Identifier: BSD-3-Clause
#include "bench/estimate/mount_check.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "bench/estimate/stream.hpp"
#include "core/lie.hpp"
#include "recordings/median.hpp"

namespace aims {
namespace {

constexpr double kLeastRotation = 0.1;  ///< of an interval that counts: turns, not steps [rad]
constexpr double kNoise = 0.02;         ///< of LiDAR odometry over it [rad]
constexpr int kFewest = 5;              ///< intervals
constexpr double kWrong = 0.3;          ///< residual of a mount that is wrong [-]
constexpr double kBetter = 0.4;         ///< residual of a better one, of the given one's [-]
constexpr double kAlike = 1.25;         ///< between residuals of mounts that fit alike [-]
constexpr double kLeastRate = 0.01;     ///< mean of LiDAR odometry of a body that turns [rad/s]
constexpr double kOtherUnit = 15.0;     ///< scale beyond noise and vibration; 57 for degrees [-]
constexpr double kClockOffset = 0.02;   ///< that counts: half of what scans of 10 Hz show [s]
constexpr Duration kHalfScan = 50 * kMillisecond;
constexpr Duration kInterval = 500 * kMillisecond;
constexpr Duration kLongest = 180 * kSecond;

struct Hypothesis {
  std::string cause;
  Eigen::Matrix3d R;  ///< proper or improper
};

double residual_of(std::span<const RotationPair> pairs, const Eigen::Matrix3d& R) {
  double sum = 0.0;
  for (const RotationPair& each : pairs) {
    sum += (each.imu - R * each.lidar).squaredNorm() /
           (each.imu.squaredNorm() + each.lidar.squaredNorm() + kNoise * kNoise);
  }
  return pairs.empty() ? 0.0 : sum / static_cast<double>(pairs.size());
}

/// The 48 matrices that permute axes and change signs.
std::vector<Eigen::Matrix3d> axis_changes() {
  std::vector<Eigen::Matrix3d> changes;
  std::array<int, 3> order = {0, 1, 2};
  do {
    for (int signs = 0; signs < 8; ++signs) {
      Eigen::Matrix3d P = Eigen::Matrix3d::Zero();
      for (int row = 0; row < 3; ++row) {
        P(row, order[static_cast<std::size_t>(row)]) = (signs >> row & 1) != 0 ? -1.0 : 1.0;
      }
      changes.push_back(P);
    }
  } while (std::next_permutation(order.begin(), order.end()));
  return changes;
}

std::string cause_of(const Eigen::Matrix3d& P) {
  if (P.determinant() < 0.0) {
    return "an axis of the gyro has the wrong sign, or two are swapped: no mount corrects that, "
           "the driver must";
  }
  const Eigen::AngleAxisd turn(P);
  const double degrees = turn.angle() * 180.0 / std::numbers::pi;
  const Eigen::Vector3d& axis = turn.axis();
  return fmt::format("the IMU is turned by {:.0f} degrees about [{:.2g}, {:.2g}, {:.2g}]", degrees,
                     axis.x(), axis.y(), axis.z());
}

/// The likelier first: inverted, upside down, turned, mirrored.
std::vector<Hypothesis> hypotheses(const Eigen::Matrix3d& given) {
  std::vector<Eigen::Matrix3d> changes = axis_changes();
  const auto rank = [](const Eigen::Matrix3d& P) {
    const bool diagonal = P.isDiagonal();
    return std::pair(P.determinant() < 0.0, !diagonal);
  };
  std::ranges::stable_sort(changes, {}, rank);
  std::vector<Hypothesis> all = {{"the extrinsic is inverted", given.transpose()}};
  for (const Eigen::Matrix3d& P : changes) {
    if (!P.isIdentity()) all.push_back({cause_of(P), P * given});
  }
  return all;
}

/// The rotation from the gyro between two stamps.
Eigen::Vector3d gyro_rotation(std::span<const ImuSample> samples, Time begin, Time end) {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  auto next = std::ranges::upper_bound(samples, begin, {}, &ImuSample::stamp);
  Time at = begin;
  for (; next != samples.end() && at < end; ++next) {
    const Time until = std::min(next->stamp, end);
    rotation = rotation * so3_exp(next->angular_velocity * to_seconds(until - at));
    at = until;
  }
  return so3_log(rotation.normalized());
}

/// Rotations over intervals of `kInterval` between poses.
std::vector<RotationPair> rotation_pairs(const Trajectory& poses,
                                         std::span<const ImuSample> samples,
                                         const Eigen::Quaterniond& R_body_lidar) {
  std::vector<RotationPair> pairs;
  std::size_t first = 0;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const Duration step = poses[i].stamp - poses[first].stamp;
    if (step < kInterval) continue;
    const Eigen::Quaterniond moved =
        poses[first].pose.rotation.conjugate() * poses[i].pose.rotation;
    RotationPair pair;
    pair.lidar = so3_log((R_body_lidar.conjugate() * moved * R_body_lidar).normalized());
    pair.imu = gyro_rotation(samples, poses[first].stamp, poses[i].stamp);
    if (step < 2 * kInterval && pair.imu.norm() > kLeastRotation) pairs.push_back(pair);
    first = i;
  }
  return pairs;
}

/// Rates between poses, at the middle of their time; the stamps of poses are `late`.
std::vector<TurnRate> rates_of(const Trajectory& poses, Duration late) {
  std::vector<TurnRate> rates;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const Duration step = poses[i].stamp - poses[i - 1].stamp;
    if (step <= 0 || step > kInterval) continue;
    const double angle = poses[i - 1].pose.rotation.angularDistance(poses[i].pose.rotation);
    rates.push_back({poses[i - 1].stamp + step / 2 - late, angle / to_seconds(step)});
  }
  return rates;
}

/// Rates of the mean over 0.1 s around each sample, as scans see them: without vibration.
std::vector<TurnRate> rates_of(std::span<const ImuSample> samples) {
  std::vector<TurnRate> rates;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  std::size_t first = 0, last = 0;
  for (const ImuSample& each : samples) {
    for (; last < samples.size() && samples[last].stamp <= each.stamp + kHalfScan; ++last) {
      sum += samples[last].angular_velocity;
    }
    for (; samples[first].stamp < each.stamp - kHalfScan; ++first) {
      sum -= samples[first].angular_velocity;
    }
    rates.push_back({each.stamp, sum.norm() / static_cast<double>(last - first)});
  }
  return rates;
}

bool is_wrong_unit(const RateCheck& check) {
  return check.scale > kOtherUnit || (check.scale > 0.0 && check.scale < 1.0 / kOtherUnit);
}

std::vector<std::string> words(const RateCheck& check, const RecordingConfig& config) {
  if (is_wrong_unit(check)) {
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

std::vector<std::string> words(const MountCheck& check, const Pose& T_imu_lidar) {
  if (check.intervals < kFewest) {
    return {
        fmt::format("mount of the LiDAR: not checked: the body turns in {} intervals of 0.5 s, at "
                    "least {} are needed",
                    check.intervals, kFewest)};
  }
  if (!check.contradicts) {
    return {
        fmt::format("mount of the LiDAR: no contradiction between LiDAR odometry and gyro over "
                    "{} rotations (residual {:.2f})",
                    check.intervals, check.given_residual)};
  }
  std::vector<std::string> lines = {
      fmt::format("MOUNT OF THE LIDAR: LiDAR odometry and gyro contradict it over {} rotations "
                  "(residual {:.2f}; {:.2f} if {})",
                  check.intervals, check.given_residual, check.best_residual, check.cause)};
  if (!check.correctable) return lines;
  const Eigen::Quaterniond& q = check.R_imu_lidar;
  const Eigen::Vector3d& t = T_imu_lidar.translation;
  lines.push_back(
      fmt::format("  to try it: --set "
                  "recording.T_imu_lidar.quaternion_xyzw=[{:.6g},{:.6g},{:.6g},{:.6g}] --set "
                  "recording.T_imu_lidar.translation=[{:.6g},{:.6g},{:.6g}]",
                  q.x(), q.y(), q.z(), q.w(), t.x(), t.y(), t.z()));
  return lines;
}

}  // namespace

RateCheck check_rates(const std::vector<TurnRate>& lidar, const std::vector<TurnRate>& gyro) {
  const auto mean = [](const std::vector<TurnRate>& rates) {
    double sum = 0.0;
    for (const TurnRate& each : rates) sum += each.rate;
    return rates.empty() ? 0.0 : sum / static_cast<double>(rates.size());
  };
  RateCheck check;
  const double turned = mean(lidar);
  check.scale = turned > kLeastRate ? mean(gyro) / turned : 0.0;
  check.clock = clock_offset(lidar, gyro);
  return check;
}

MountCheck check_mount(std::span<const RotationPair> pairs, const Eigen::Quaterniond& R_imu_lidar) {
  MountCheck check;
  check.intervals = static_cast<int>(pairs.size());
  check.R_imu_lidar = R_imu_lidar;
  check.given_residual = check.best_residual = residual_of(pairs, R_imu_lidar.toRotationMatrix());
  if (check.intervals < kFewest) return check;
  const auto all = hypotheses(R_imu_lidar.toRotationMatrix());
  std::vector<double> residuals;
  for (const Hypothesis& each : all) residuals.push_back(residual_of(pairs, each.R));
  const double least = *std::ranges::min_element(residuals);
  const auto first =
      std::ranges::find_if(residuals, [least](double each) { return each <= kAlike * least; });
  const Hypothesis& best = all[static_cast<std::size_t>(first - residuals.begin())];
  check.best_residual = *first;
  check.cause = best.cause;
  check.correctable = best.R.determinant() > 0.0;
  if (check.correctable) check.R_imu_lidar = Eigen::Quaterniond(best.R).normalized();
  check.contradicts =
      check.given_residual > kWrong && check.best_residual < kBetter * check.given_residual;
  if (check.contradicts) return check;
  check.cause.clear();
  check.correctable = false;
  check.R_imu_lidar = R_imu_lidar;
  return check;
}

Result<std::vector<std::string>> mount_report(const EstimateConfig& config,
                                              const EstimateOptions& options) {
  auto reader = RecordingReader::open(options.bag, config.recording,
                                      {.recover = options.recover, .with = options.with});
  if (!reader) return tl::unexpected(reader.error());
  const RecordingSetup setup = reader->setup();
  if (setup.topics.lidar.empty() || setup.topics.imu.empty() || setup.rings.count == 0) {
    return std::vector<std::string>{"mount of the LiDAR: not checked: needs an IMU and rings"};
  }
  const std::array<std::string, 1> run = {"a_loam"};
  auto estimators = make_estimators(run, config.estimators, setup.rig);
  if (!estimators) return tl::unexpected(estimators.error());
  std::vector<ImuSample> samples;
  std::vector<Duration> scan_times;
  const auto next_batch = [&](std::vector<Delivery>& batch) {
    auto more = reader->advance(kStreamBatch, batch);
    for (const Delivery& each : batch) {
      if (const auto* imu = std::get_if<ImuSample>(&each.measurement)) samples.push_back(*imu);
      if (const auto* scan = std::get_if<LidarScanPtr>(&each.measurement)) {
        scan_times.push_back((*scan)->end - (*scan)->stamp);
      }
    }
    return more;
  };
  stream(next_batch, *estimators, 1, [&] { return reader->position() < kLongest; });
  std::ranges::stable_sort(samples, {}, &ImuSample::stamp);
  const Pose& T_imu_lidar = setup.rig.T_body_lidar;
  const Trajectory& poses = estimators->front().estimator().result().trajectory;
  // A-LOAM takes scans as rigid: its poses are those of the middle of a scan, stamped at its end.
  const Duration half_scan = upper_median(scan_times).value_or(0) / 2;
  const RateCheck rates = check_rates(rates_of(poses, half_scan), rates_of(samples));
  std::vector<std::string> lines = words(rates, config.recording);
  if (is_wrong_unit(rates)) return lines;
  const auto pairs = rotation_pairs(poses, samples, T_imu_lidar.rotation);
  for (std::string& line : words(check_mount(pairs, T_imu_lidar.rotation), T_imu_lidar)) {
    lines.push_back(std::move(line));
  }
  return lines;
}

}  // namespace aims
