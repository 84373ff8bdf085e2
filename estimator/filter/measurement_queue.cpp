// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/filter/measurement_queue.hpp"

#include <algorithm>
#include <cmath>

namespace aims {
namespace {

constexpr double kMaxWait = 60.0;  ///< bound on configured waiting times [s]

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
           {"s", in_range(0.0, kMaxWait), "measurements wait this long for earlier ones"});
  f.number("imu_wait", c.imu_wait,
           {"s", in_range(0.0, kMaxWait), "corrections wait this long for the IMU"});
  f.number("max_ahead", c.max_ahead,
           {"s", positive(), "a stamp further ahead of its arrival is rejected"});
  f.integer("max_held", c.max_held, {"-", at_least(100), "bound on measurements held back"});
}

MeasurementQueue::MeasurementQueue(const QueueConfig& config, const ImuPropagationConfig& imu,
                                   double imu_rate_hz, double max_leg_speed)
    : config_(config), imu_config_(imu), max_leg_speed_(max_leg_speed), imu_(imu, imu_rate_hz) {}

void MeasurementQueue::push(const Delivery& delivery) {
  now_ = now_ ? std::max(*now_, delivery.arrival) : delivery.arrival;
  std::visit([this](const auto& each) { accept(each); }, delivery.measurement);
}

bool MeasurementQueue::plausible_stamp(Time stamp, const std::string& name) {
  if (stamp <= *now_ + from_seconds(config_.max_ahead)) return true;
  count(name + ".ahead");
  return false;
}

void MeasurementQueue::accept(const ImuSample& sample) {
  if (!sample.angular_velocity.allFinite() || !sample.specific_force.allFinite()) {
    return count("imu.non_finite");
  }
  if (sample.angular_velocity.norm() > imu_config_.max_rate ||
      sample.specific_force.norm() > imu_config_.max_force) {
    return count("imu.out_of_range");
  }
  if (!plausible_stamp(sample.stamp, "imu")) return;
  if (last_popped_ && sample.stamp <= last_popped_->first) return count("imu.late");
  if (!imu_.insert(sample)) return count("imu.duplicate");
  if (imu_.samples().size() > static_cast<std::size_t>(config_.max_held)) {
    imu_.forget_before(imu_.samples()[1].stamp + 1);
  }
}

void MeasurementQueue::accept(const LegOdometrySample& sample) {
  if (!sample.linear_velocity.allFinite() || !sample.angular_velocity.allFinite() ||
      !is_finite(sample.T_odom_base)) {
    return count("leg.non_finite");
  }
  if (sample.linear_velocity.norm() > max_leg_speed_) return count("leg.out_of_range");
  if (plausible_stamp(sample.stamp, "leg")) hold({sample.stamp, kLegKind}, "leg", sample);
}

void MeasurementQueue::accept(const LidarScanPtr& scan) {
  if (!scan || scan->end < scan->stamp || scan->end - scan->stamp > kMaxScanDuration) {
    return count("lidar.out_of_range");
  }
  if (plausible_stamp(scan->end, "lidar")) hold({scan->end, kLidarKind}, "lidar", scan);
}

void MeasurementQueue::hold(const Key& key, const std::string& name, Correction correction) {
  if (last_popped_ && key <= *last_popped_) {
    return count(name + (key == *last_popped_ ? ".duplicate" : ".late"));
  }
  if (!held_.try_emplace(key, std::move(correction)).second) return count(name + ".duplicate");
  if (held_.size() > static_cast<std::size_t>(config_.max_held)) {
    held_.erase(held_.begin());
    count("queue.overflow");
  }
}

bool MeasurementQueue::ready(Time stamp) const {
  if (closed_) return true;
  if (*now_ < stamp + from_seconds(config_.lag)) return false;
  const std::optional<Time> newest = imu_.newest();
  return (newest && *newest >= stamp) || *now_ >= stamp + from_seconds(config_.imu_wait);
}

std::optional<Correction> MeasurementQueue::pop() {
  if (held_.empty() || !ready(held_.begin()->first.first)) return std::nullopt;
  auto first = held_.extract(held_.begin());
  last_popped_ = first.key();
  return std::move(first.mapped());
}

}  // namespace aims
