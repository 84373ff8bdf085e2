// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/aims/health_monitor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "estimator/degeneracy/cross_validation.hpp"

namespace aims {
namespace {

// Limits on the input. Shorter gaps are what packet loss and jitter make.
constexpr double kImuGap = 0.2;          ///< the bridge over missing samples is rough beyond [s]
constexpr double kGap = 0.5;             ///< of legs or LiDAR [s]
constexpr double kLongImuGap = 2.0;      ///< attitude and velocity are then guesses [s]
constexpr double kLongGap = 5.0;         ///< without any correction [s]
constexpr double kMaxRejected = 0.5;     ///< fraction of a sensor's measurements
constexpr double kSearchedOutage = 2.0;  ///< of IMU and LiDAR; drift is searched no farther [s]
constexpr double kForceTolerance = 0.2;  ///< of the mean specific force, relative to gravity

// Limits on how sources disagree.
constexpr double kLegDisagreement = 0.15;       ///< several times a usual scale error [m/s]
constexpr double kLargeLegDisagreement = 0.5;   ///< about the speed of a walk [m/s]
constexpr double kRotationDisagreement = 5e-3;  ///< of scan and prediction [rad]; usual: 2e-4
constexpr double kPositionDisagreement = 0.01;  ///< of scan and prediction [m]; usual: 2e-3
constexpr double kNoiseFactor = 3.0;            ///< on what the noise of the IMU makes of them
constexpr double kScanInterval = 0.1;           ///< over which it acts [s]
constexpr int kScansWithoutUpdate = 5;
constexpr int kLongWithoutUpdate = 50;
constexpr int kWeakScans = 50;

// Limits on the estimate.
constexpr double kMaxSpeed = 5.0;       ///< no walking robot is faster [m/s]
constexpr double kMinSpeed = 0.1;       ///< standing scans repeat one noise sample [m/s]
constexpr double kSigmaOffset = 1.0;    ///< stated deviation at the start [m]
constexpr double kSigmaPerPath = 0.05;  ///< and its growth per metre of path [-]

// Moving averages.
constexpr double kLegSamples = 200.0;
constexpr double kScans = 20.0;

}  // namespace

struct HealthMonitor::Findings {
  std::vector<std::string> degraded;
  std::vector<std::string> invalid;
};

HealthEstimate health_estimate(const Belief& belief, const Eigen::Matrix3d& others) {
  const ErrorMatrix stated = stated_covariance(belief);
  const Eigen::Matrix3d P = block(stated, ErrorState::kPosition, ErrorState::kPosition) + others;
  return {belief.state.position, belief.state.velocity.norm(),
          std::sqrt(std::max(0.0, P.diagonal().maxCoeff()))};
}

void HealthMonitor::leg_residual(const Eigen::Vector3d& residual) {
  leg_residual_ += (residual - leg_residual_) / kLegSamples;
}

void HealthMonitor::scan(const ScanDiagnostics& scan, std::size_t points) {
  scans_without_update_ = scan.iterations == 0 ? scans_without_update_ + 1 : 0;
  const double matched = points == 0 ? 0.0 : scan.points_used / static_cast<double>(points);
  matched_ += (matched - matched_) / kScans;
  if (scan.iterations == 0) return;
  const auto average = [](double value, double& mean) {
    if (std::isfinite(value)) mean += (value - mean) / kScans;
  };
  average(scan.innovation_rotation.norm(), rotation_residual_);
  average(scan.innovation_position.norm(), position_residual_);
  average(scan.imu_noise.gyro * std::sqrt(kScanInterval), expected_rotation_);
  average(scan.imu_noise.accelerometer * std::pow(kScanInterval, 1.5), expected_position_);
  average(scan.weak_tilt, weak_tilt_);
  weak_scans_ = scan.weak_tilt < kFreeTilt ? weak_scans_ + 1 : 0;
}

bool HealthMonitor::lidar_corrects(Time now, const InputMonitor& inputs) const {
  return sources_.lidar && inputs.silence(Sensor::kLidar, now) < kLongGap &&
         scans_without_update_ < kLongWithoutUpdate;
}

void HealthMonitor::judge_inputs(Time now, const InputMonitor& inputs, Findings& findings) const {
  const std::tuple<bool, Sensor, double, const char*> sources[] = {
      {sources_.imu, Sensor::kImu, kImuGap, "IMU data"},
      {sources_.legs, Sensor::kLegs, kGap, "leg odometry"},
      {sources_.lidar, Sensor::kLidar, kGap, "LiDAR scans"}};
  for (const auto& [used, sensor, gap, name] : sources) {
    if (!used) continue;
    if (inputs.silence(sensor, now) > gap) findings.degraded.push_back(fmt::format("no {}", name));
    if (inputs.rejected_fraction(sensor) > kMaxRejected) {
      findings.degraded.push_back(fmt::format("{} rejected", name));
    }
  }
  if (sources_.imu && inputs.silence(Sensor::kImu, now) > kLongImuGap) {
    findings.invalid.emplace_back("no IMU data for long");
  }
  const bool legs_correct = sources_.legs && inputs.silence(Sensor::kLegs, now) < kLongGap;
  if (!legs_correct && !lidar_corrects(now, inputs)) {
    findings.invalid.emplace_back("neither LiDAR nor legs correct the estimate");
  }
  const auto force = sources_.imu ? inputs.mean_force() : std::nullopt;
  if (force && std::abs(*force - gravity_) > kForceTolerance * gravity_) {
    findings.invalid.push_back(
        fmt::format("mean specific force {:.1f} m/s^2, not gravity", *force));
  }
}

void HealthMonitor::outage(double duration) {
  if (!sources_.lidar || duration > kSearchedOutage) position_lost_ = true;
}

void HealthMonitor::judge_agreement(Findings& findings) const {
  if (sources_.lidar && scans_without_update_ >= kScansWithoutUpdate) {
    findings.degraded.emplace_back("scans do not match the map");
  } else if (sources_.lidar && matched_ < kMinMatched) {
    findings.degraded.emplace_back("few points match the map");
  }
  const double legs = leg_residual_.norm();
  if (legs > kLargeLegDisagreement) {
    findings.invalid.emplace_back("legs contradict the estimate");
  } else if (legs > kLegDisagreement) {
    findings.degraded.emplace_back("legs disagree with the estimate");
  }
  if (rotation_residual_ > kRotationDisagreement + kNoiseFactor * expected_rotation_) {
    findings.degraded.emplace_back("scans disagree with the predicted rotation");
  }
  if (position_residual_ > kPositionDisagreement + kNoiseFactor * expected_position_) {
    findings.degraded.emplace_back("scans disagree with the predicted position");
  }
  if (position_lost_) {
    findings.degraded.emplace_back("position lost in an outage of the sensors");
  }
  if (calibration_contradicted_) {
    findings.degraded.emplace_back("the robot differs from its calibration");
  }
  if (not_finite_) findings.degraded.emplace_back("an update was not finite");
}

void HealthMonitor::judge_estimate(const HealthEstimate& estimate, bool scans_hold_the_way,
                                   Findings& findings) {
  if (last_position_) path_ += (estimate.position - *last_position_).norm();
  last_position_ = estimate.position;
  if (estimate.speed > kMaxSpeed) findings.invalid.emplace_back("faster than a robot walks");
  if (estimate.speed < kMinSpeed) weak_scans_ = 0;
  if (!sources_.legs && weak_scans_ >= kWeakScans) {
    findings.degraded.emplace_back("scans leave one direction free");
  }
  if (estimate.soft_leg_sigma > kSigmaPerPath && !scans_hold_the_way) {
    findings.degraded.emplace_back("soft joints make the distance uncertain");
  }
  const double limit = kSigmaOffset + kSigmaPerPath * path_;
  if (estimate.position_sigma > limit) {
    findings.invalid.emplace_back("position uncertain");
  } else if (2.0 * estimate.position_sigma > limit) {
    findings.degraded.emplace_back("position uncertain");
  }
}

void close_health(std::vector<HealthRow>& rows, HealthRow row) {
  const bool same = !rows.empty() && rows.back().state == row.state &&
                    rows.back().reasons == row.reasons && rows.back().stamp == row.stamp;
  if (!same) rows.push_back(std::move(row));
}

HealthRow HealthMonitor::judge(Time now, const InputMonitor& inputs,
                               const std::optional<HealthEstimate>& estimate) {
  Findings findings;
  HealthRow row;
  row.stamp = now;
  row.position_sigma = estimate ? estimate->position_sigma : kNotComputed;
  judge_inputs(now, inputs, findings);
  if (estimate) {
    judge_agreement(findings);
    const bool scans_hold_the_way = lidar_corrects(now, inputs) && weak_tilt_ > kFreeTilt;
    judge_estimate(*estimate, scans_hold_the_way, findings);
  }
  not_finite_ = false;
  if (!findings.invalid.empty()) {
    row.state = HealthState::kInvalid;
  } else if (!estimate) {
    row.state = HealthState::kStarting;
  } else {
    row.state = findings.degraded.empty() ? HealthState::kHealthy : HealthState::kDegraded;
  }
  row.reasons = std::move(findings.invalid);
  if (estimate) {
    row.reasons.insert(row.reasons.end(), findings.degraded.begin(), findings.degraded.end());
  }
  return row;
}

}  // namespace aims
