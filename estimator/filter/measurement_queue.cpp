// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/filter/measurement_queue.hpp"

#include <algorithm>
#include <cmath>

namespace aims {
namespace {

constexpr double kMaxWait = 60.0;  ///< bound on configured waiting times [s]

/// Beyond the ranges of inertial sensors on robots: 2000 deg/s are 35 rad/s, 30 g 294 m/s^2.
constexpr double kMaxRate = 40.0;    ///< [rad/s]
constexpr double kMaxForce = 300.0;  ///< [m/s^2]

/// Corrections wait this long for the IMU to cover them.
constexpr Duration kImuWait = 300 * kMillisecond;

constexpr int kLegKind = 0;
constexpr int kLidarKind = 1;

/// Longer scans are out of range.
constexpr Duration kMaxScanDuration = kSecond;

bool is_finite(const Pose& pose) {
  return pose.rotation.coeffs().allFinite() && pose.translation.allFinite();
}

}  // namespace

void describe(Fields& f, QueueConfig& c) {
  f.number("lag", c.lag,
           {"s", in_range(0.0, kMaxWait), "measurements wait this long for earlier ones",
            "chosen: more than drivers delay a message, 5 to 20 ms"});
  f.number("max_ahead", c.max_ahead,
           {"s", positive_up_to(1e6), "a stamp further ahead of its arrival is rejected",
            "chosen: clocks that are set agree far better"});
}

MeasurementQueue::MeasurementQueue(const QueueConfig& config, const ImuPropagationConfig& imu,
                                   double imu_rate_hz, double max_leg_speed)
    : config_(config), max_leg_speed_(max_leg_speed), imu_(imu, imu_rate_hz) {}

/// "imu", "leg" or "lidar": how the names of the counts begin.
void MeasurementQueue::count(Sensor sensor, const char* what, int times) {
  constexpr const char* kNames[kSensorCount] = {"imu.", "leg.", "lidar."};
  if (times <= 0) return;
  counts_[std::string(kNames[static_cast<int>(sensor)]) + what] += times;
  counted_ += times;
}

void MeasurementQueue::reject(Sensor sensor, const char* reason) {
  inputs_.rejected(sensor, *now_);
  count(sensor, reason);
}

void MeasurementQueue::push(const Delivery& delivery) {
  now_ = now_ ? std::max(*now_, delivery.arrival) : delivery.arrival;
  const auto sensor = static_cast<Sensor>(delivery.measurement.index());
  const auto* scan = std::get_if<LidarScanPtr>(&delivery.measurement);
  if (scan != nullptr && *scan == nullptr) return reject(sensor, "out_of_range");
  if (!plausible_stamp(stamp_of(delivery.measurement), sensor)) return;
  StampJumps& jumps = stamp_jumps_[static_cast<std::size_t>(sensor)];
  const int dropped = jumps.dropped();
  const int clock_jumps = jumps.clock_jumps();
  good_.clear();
  jumps.take(delivery, good_);
  count(sensor, "stamp_jump", jumps.dropped() - dropped);
  count(sensor, "clock_jump", jumps.clock_jumps() - clock_jumps);
  for (const Delivery& each : good_) {
    std::visit([this](const auto& measurement) { accept(measurement); }, each.measurement);
  }
}

bool MeasurementQueue::plausible_stamp(Time stamp, Sensor sensor) {
  if (stamp <= *now_ + from_seconds(config_.max_ahead)) return true;
  reject(sensor, "ahead");
  return false;
}

void MeasurementQueue::accept(const ImuSample& sample) {
  if (!sample.angular_velocity.allFinite() || !sample.specific_force.allFinite()) {
    return reject(Sensor::kImu, "non_finite");
  }
  if (sample.angular_velocity.norm() > kMaxRate || sample.specific_force.norm() > kMaxForce) {
    return reject(Sensor::kImu, "out_of_range");
  }
  if (last_popped_ && sample.stamp <= last_popped_->first) return reject(Sensor::kImu, "late");
  if (!imu_.insert(sample)) return count(Sensor::kImu, "duplicate");
  inputs_.accepted(Sensor::kImu, *now_);
  inputs_.accepted_force(sample.specific_force);
  if (imu_.samples().size() > kMaxHeld) {
    imu_.forget_before(imu_.samples()[1].stamp + 1);
  }
}

void MeasurementQueue::accept(const LegOdometrySample& sample) {
  if (!sample.linear_velocity.allFinite() || !sample.angular_velocity.allFinite() ||
      !is_finite(sample.T_odom_base)) {
    return reject(Sensor::kLegs, "non_finite");
  }
  if (sample.linear_velocity.norm() > max_leg_speed_) return reject(Sensor::kLegs, "out_of_range");
  hold({sample.stamp, kLegKind}, Sensor::kLegs, sample);
}

void MeasurementQueue::accept(const LidarScanPtr& scan) {
  if (scan->end < scan->stamp || scan->end - scan->stamp > kMaxScanDuration) {
    return reject(Sensor::kLidar, "out_of_range");
  }
  hold({scan->end, kLidarKind}, Sensor::kLidar, scan);
}

void MeasurementQueue::hold(const Key& key, Sensor sensor, Correction correction) {
  if (last_popped_ && key == *last_popped_) return count(sensor, "duplicate");
  if (last_popped_ && key < *last_popped_) return reject(sensor, "late");
  if (!held_.try_emplace(key, std::move(correction)).second) return count(sensor, "duplicate");
  inputs_.accepted(sensor, *now_);
  if (held_.size() > kMaxHeld) {
    held_.erase(held_.begin());
    ++counts_["queue.overflow"];
    ++counted_;
  }
}

bool MeasurementQueue::ready(Time stamp) const {
  if (closed_) return true;
  // IMU samples up to this stamp have a share in the motion before `stamp`.
  const Time last_needed = stamp + std::max<Duration>(imu_.delay(), 0);
  if (*now_ < last_needed + from_seconds(config_.lag)) return false;
  const std::optional<Time> newest = imu_.newest();
  return (newest && *newest >= stamp) || *now_ >= stamp + kImuWait;
}

std::optional<Correction> MeasurementQueue::pop() {
  if (held_.empty() || !ready(held_.begin()->first.first)) return std::nullopt;
  last_popped_ = held_.begin()->first;
  Correction first = std::move(held_.begin()->second);
  held_.erase(held_.begin());
  return first;
}

}  // namespace aims
