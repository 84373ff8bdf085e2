// SPDX-License-Identifier: BSD-3-Clause
// Of the survey of a recording: units, rate and orientation of the IMU.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/median.hpp"
#include "recordings/stream/gravity_unit.hpp"
#include "recordings/stream/motion_window.hpp"
#include "recordings/stream/recording_survey.hpp"

namespace aims {
namespace {

constexpr double kMaxTurnRate = 35.0;  ///< saturation of a gyro of 2000 deg/s [rad/s]
/// Median turn rate of no walking robot [rad/s].
constexpr double kFastTurning = 4.0;
constexpr double kLeastGravity = 0.5;  ///< of the mean force, as a fraction of the median norm
/// Of a specific force in m/s^2, in the median.
constexpr double kLeastForce = 5.0, kMostForce = 15.0;
constexpr double kStrangeImu = 5.0;    ///< of stamps in another unit [Hz]
constexpr double kSlowImu = 40.0;      ///< too slow for a walk [Hz]
constexpr double kFastImu = 20'000.0;  ///< [Hz]

}  // namespace

double RecordingSurvey::median_norm(Eigen::Vector3d ImuSample::*part) const {
  std::vector<double> norms;
  for (const ImuSample& each : first_samples_) norms.push_back((each.*part).norm());
  return upper_median(std::move(norms)).value_or(0.0);
}

Eigen::Vector3d RecordingSurvey::force_sum() const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const ImuSample& each : first_samples_) sum += each.specific_force;
  return sum;
}

/// Whether any sample differs from the first one in this.
bool RecordingSurvey::changes(Eigen::Vector3d ImuSample::*part) const {
  return std::ranges::any_of(first_samples_, [&](const ImuSample& each) {
    return each.*part != first_samples_.front().*part;
  });
}

/// Warns of a specific force that is no gravity.
void RecordingSurvey::warn_of_force(double force) {
  if (force == 0.0 && largest_turn_rate_ == 0.0) {
    return notes_.warn("IMU measures nothing",
                       "gyro and accelerometer are zero in the first messages of the IMU: does it "
                       "give its orientation alone? Estimators need both");
  }
  const double milligravities = force / 1000.0;
  notes_.warn(
      "unit of the accelerometer unknown",
      fmt::format("specific force of {:.3g} at the start is neither gravity in m/s^2 nor in "
                  "g: {}",
                  force,
                  is_in_gravities(milligravities)
                      ? "it seems to be in mg: set recording.imu_unit=mg"
                      : "assumed to be m/s^2 (imu_unit); convert raw counts before"));
}

/// The unit of the accelerometer, which gravity gives away.
void RecordingSurvey::decide_force_unit(RecordingPlan& plan) {
  ReadingNotes& notes = notes_;
  const double force = median_norm(&ImuSample::specific_force);
  const bool milli = config_.imu_unit == ImuUnit::kMilligravities;
  bool gravities = milli || config_.imu_unit == ImuUnit::kGravities;
  // Gravity adds up over the samples; accelerations of a walk without it do not.
  const bool any = !first_samples_.empty();
  const double mean = any ? force_sum().norm() / static_cast<double>(first_samples_.size()) : 0.0;
  const bool gravity_free = any && mean < kLeastGravity * force;
  if (gravity_free) {
    notes.warn("accelerometer without gravity",
               fmt::format("specific force of {:.3g} in the median but {:.3g} in the mean: gravity "
                           "is taken out, or the axes change; estimators need it as measured",
                           force, mean));
  } else if (config_.imu_unit == ImuUnit::kAuto && any) {
    gravities = is_in_gravities(force);
    if (!gravities && (force < kLeastForce || force > kMostForce)) warn_of_force(force);
  }
  if (gravities) {
    plan.force_scale = milli ? kStandardGravity / 1000.0 : kStandardGravity;
    notes.push_back(fmt::format("IMU in {} ({:.4g} at the start): multiplied by {}",
                                milli ? "mg" : "g", force, plan.force_scale));
  }
}

void RecordingSurvey::warn_of_rate(double rate) {
  if (rate < kStrangeImu || rate > kFastImu) {
    notes_.warn("rate of the IMU",
                fmt::format("IMU of {:.3g} Hz by its stamps: are they in another unit than seconds "
                            "(of a table: time_unit of its mapping), or are most of them lost?",
                            rate));
  } else if (rate < kSlowImu) {
    notes_.warn("IMU is slow",
                fmt::format("IMU of {:.3g} Hz: a walk shakes faster than it samples, estimates "
                            "that rely on it drift; 50 Hz at least are expected, 100 Hz or more "
                            "recommended: is it sent at a reduced rate?",
                            rate));
  }
}

/// Notes an orientation of the IMU whose upward direction is not that of the specific force.
void RecordingSurvey::note_orientation() {
  constexpr double kApart = 0.35, kNear = 0.1;  // [rad]
  double apart = 0.0, turned = 0.0;             // sums, also of quaternions that begin with x
  int count = 0;
  for (const ImuSample& each : first_samples_) {
    if (!each.orientation || !(each.specific_force.norm() > 0.0)) continue;
    const Eigen::Vector3d up = each.specific_force.normalized();
    const auto angle_of = [&up](const Eigen::Quaterniond& q) {
      return std::acos(std::clamp((q * up).z(), -1.0, 1.0));
    };
    const Eigen::Quaterniond& q = *each.orientation;
    apart += angle_of(q);
    turned += angle_of({q.z(), q.w(), q.x(), q.y()});
    ++count;
  }
  if (count == 0 || apart < kApart * count) return;
  notes_.push_back(fmt::format(
      "IMU: its orientation is {:.2f} rad off the specific force in the mean{}; systems that use "
      "it "
      "(LIO-SAM) need another one",
      apart / count,
      turned < kNear * count ? ", as where the quaternion begins with x in place of w" : ""));
}

void RecordingSurvey::decide_imu(RecordingPlan& plan) {
  ReadingNotes& notes = notes_;
  plan.setup.imu_rate_hz = rate_of(Role::kImu, plan);
  plan.setup.has_orientation = oriented_;
  note_orientation();
  adopt_rate(plan.setup.imu_rate_hz, "IMU", plan.setup.rig.imu_rate_hz);
  if (const auto rate = plan.setup.imu_rate_hz) warn_of_rate(*rate);
  decide_force_unit(plan);
  for (const std::string& type : unstamped_states()) {
    notes.push_back(fmt::format("{} has no stamp: record times are used", type));
  }
  if (config_.gyro_unit == GyroUnit::kDegrees) {
    plan.turn_scale = std::numbers::pi / 180.0;
    notes.push_back("angular velocity in deg/s (recording.gyro_unit): converted to rad/s");
  }
  warn_of_gyro(plan);
  warn_of_gravity(plan);
}

/// Warns of a gyro whose numbers no robot turns by.
void RecordingSurvey::warn_of_gyro(const RecordingPlan& plan) {
  const double turning = plan.turn_scale * median_norm(&ImuSample::angular_velocity);
  const double fastest = plan.turn_scale * largest_turn_rate_;
  constexpr std::size_t kLeast = 100;  // samples
  constexpr double kFewBeyond = 0.01;  // of them
  if (first_samples_.size() >= kLeast && !changes(&ImuSample::angular_velocity) &&
      changes(&ImuSample::specific_force)) {
    const Eigen::Vector3d rate = first_samples_.front().angular_velocity.array() + 0.0;  // no -0
    notes_.warn("gyroscope does not measure",
                fmt::format("angular velocity is ({:.3g}, {:.3g}, {:.3g}) in all {} samples while "
                            "the specific force changes: the gyro is off or not filled in",
                            rate.x(), rate.y(), rate.z(), first_samples_.size()));
  }
  const auto beyond = std::ranges::count_if(first_samples_, [&](const ImuSample& each) {
    return plan.turn_scale * each.angular_velocity.norm() > kMaxTurnRate;
  });
  const bool spikes = static_cast<double>(beyond) < kFewBeyond * std::ssize(first_samples_);
  if (fastest > kMaxTurnRate && turning < kFastTurning && spikes) {
    notes_.warn("gyroscope has spikes",
                fmt::format("{} of the first {} samples of the gyro are beyond {:.0f} rad/s, up to "
                            "{:.3g}, {:.3g} in the median: single samples are corrupt",
                            beyond, first_samples_.size(), kMaxTurnRate, fastest, turning));
  } else if (fastest > kMaxTurnRate || turning > kFastTurning) {
    notes_.warn("gyroscope perhaps in deg/s",
                fmt::format("angular velocity up to {:.3g}, {:.3g} in the median: rad/s are "
                            "expected, are these deg/s? Then set recording.gyro_unit=deg/s (of a "
                            "table: gyro_unit of its mapping)",
                            fastest, turning));
  }
}

/// The mean specific force of the second without motion in which it is nearest to gravity.
std::optional<double> RecordingSurvey::force_at_rest(const RecordingPlan& plan) const {
  std::optional<double> nearest;
  MotionWindow window;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;
  for (const ImuSample& each : first_samples_) {
    if (window.length_to(each.stamp) >= kSecond) {
      const double force = sum.norm() / count;
      const bool nearer =
          !nearest || std::abs(force - kStandardGravity) < std::abs(*nearest - kStandardGravity);
      if (!window.moves() && nearer) nearest = force;
      window = {};
      sum.setZero();
      count = 0;
    }
    const Eigen::Vector3d force = plan.force_scale * each.specific_force;
    window.add(each.stamp, plan.turn_scale * each.angular_velocity, force);
    sum += force;
    ++count;
  }
  return nearest;
}

/// Warns of a robot at rest whose specific force is not gravity.
void RecordingSurvey::warn_of_gravity(const RecordingPlan& plan) {
  constexpr double kTolerance = 0.05;  // biases are below 0.02
  const double force = force_at_rest(plan).value_or(kStandardGravity);
  const double off = std::abs(force / kStandardGravity - 1.0);
  // Beyond, the unit is warned of.
  if (off < kTolerance || force < kLeastForce || force > kMostForce) return;
  notes_.warn("accelerometer does not measure gravity",
              fmt::format("specific force of {:.2f} m/s^2 at rest is {:.0f} % off gravity: the "
                          "scale of the accelerometer or of one of its axes is wrong",
                          force, 1e2 * off));
}

/// Warns of a robot that stands for no second of the first two: the estimate begins with the
/// longest part of them that is undisturbed.
void RecordingSurvey::warn_of_motion(const RecordingPlan& plan) {
  if (first_samples_.empty()) return;
  MotionWindow window;
  int windows = 0;
  int moving = 0;
  Time last = first_samples_.front().stamp;
  const auto judge = [&] {
    if (window.length_to(last) < kSecond * 9 / 10) return;
    ++windows;
    if (window.moves()) ++moving;
  };
  for (const ImuSample& each : first_samples_) {
    const Duration since = each.stamp - first_samples_.front().stamp;
    if (since < 0 || since >= 2 * kSecond) break;
    if (window.length_to(each.stamp) >= kSecond) {
      judge();
      window = {};
    }
    window.add(each.stamp, plan.turn_scale * each.angular_velocity,
               plan.force_scale * each.specific_force);
    last = each.stamp;
  }
  judge();
  if (windows == 0 || moving < windows) return;
  notes_.warn("robot moves at the start",
              "the robot moves in the first two seconds, in which it is taken to stand: tilt, "
              "velocity and gyro bias are then wrong; begin the recording before it walks");
}

}  // namespace aims
