// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/legs/axis_signs.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "core/lie.hpp"

namespace aims {
namespace {

constexpr Duration kHalfSecond = kSecond / 2;
constexpr double kLongestStep = 0.1;     ///< between samples of the IMU [s]
constexpr double kLevelling = 0.2;       ///< of the attitude to the specific force [1/s]
constexpr int kFewestOfWindow = 8;       ///< samples
constexpr int kFewestChanges = 12;       ///< half seconds
constexpr double kLeastResidual = 0.05;  ///< [m/s]
constexpr double kClearlySmaller = 0.6;  ///< 0.41 on a real robot, 2.4 where the sign is right

}  // namespace

ForceStep SignedForce::add_imu(const ImuSample& sample, const Eigen::Vector3d& place) {
  const Eigen::Vector3d force = signs_.cwiseProduct(sample.specific_force);
  const double norm = force.norm();
  if (!std::isfinite(norm) || !(norm > 0.1) || !sample.angular_velocity.allFinite()) {
    return ForceStep::kRefused;
  }
  const double step = last_ ? to_seconds(sample.stamp - *last_) : 0.0;
  const bool anew = !last_ || step <= 0.0 || step > kLongestStep;
  if (anew) {
    R_world_base_ = Eigen::Quaterniond::FromTwoVectors(force, Eigen::Vector3d::UnitZ());
    window_.reset();
    begin_ = sample.stamp;
    imu_ = legs_ = 0;
    sum_ = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  } else {
    const Eigen::Vector3d predicted = R_world_base_.conjugate() * Eigen::Vector3d::UnitZ();
    const Eigen::Vector3d levelled = kLevelling * (force / norm).cross(predicted);
    R_world_base_ =
        (R_world_base_ * so3_exp(step * (sample.angular_velocity + levelled))).normalized();
    velocity_ += R_world_base_ * force * step;
    time_ += step;
    ++steps_;
  }
  last_ = sample.stamp;
  turning_ = sample.angular_velocity;
  place_ = place;
  ++imu_;
  sum_.by_force += velocity_;
  if (anew) return ForceStep::kBeganAnew;
  if (sample.stamp - begin_ < kHalfSecond) return ForceStep::kAdded;
  close();
  return ForceStep::kClosedWindow;
}

void SignedForce::add_legs(const Eigen::Vector3d& velocity) {
  if (!last_ || !velocity.allFinite()) return;
  ++legs_;
  sum_.by_legs += R_world_base_ * (velocity + turning_.cross(place_));
}

void SignedForce::close() {
  std::optional<Velocities> now;
  if (imu_ >= kFewestOfWindow && legs_ >= kFewestOfWindow) {
    now = Velocities{sum_.by_force / imu_, sum_.by_legs / legs_};
  }
  const auto before = std::exchange(window_, now);
  change_.reset();
  if (before && now) {
    const auto R_base_world = yaw_rotation(-yaw_of(R_world_base_));
    change_ = Velocities{R_base_world * (now->by_force - before->by_force),
                         R_base_world * (now->by_legs - before->by_legs)};
    squared_ += (change_->by_force - change_->by_legs).head<2>().array().square();
    ++count_;
  }
  imu_ = legs_ = 0;
  sum_ = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  begin_ = *last_;
}

Eigen::Array2d SignedForce::residual() const {
  return (squared_ / static_cast<double>(count_ > 0 ? count_ : 1)).sqrt();
}

ForceStep AxisSigns::add_imu(const ImuSample& sample, const Eigen::Vector3d& place) {
  for (SignedForce& each : mirrored_) each.add_imu(sample, place);
  return measured_.add_imu(sample, place);
}

void AxisSigns::add_legs(const Eigen::Vector3d& velocity) {
  measured_.add_legs(velocity);
  for (SignedForce& each : mirrored_) each.add_legs(velocity);
}

bool AxisSigns::mirrored_x_fits() const {
  return mirrored_[0].residual().x() < measured_.residual().x();
}

std::optional<ReadingWarning> AxisSigns::warning() const {
  if (measured_.count() < kFewestChanges) return std::nullopt;
  for (std::size_t axis = 0; axis < mirrored_.size(); ++axis) {
    const auto at = static_cast<Eigen::Index>(axis);
    const double measured = measured_.residual()[at], mirrored = mirrored_[axis].residual()[at];
    if (measured < kLeastResidual || mirrored > kClearlySmaller * measured) continue;
    return ReadingWarning{
        "legs contradict the accelerometer",
        fmt::format("{} of the accelerometer, or of the velocity by the legs, has the wrong sign: "
                    "over {} half seconds the velocity "
                    "along {} changes by {:.2f} m/s otherwise than by the legs, with the other "
                    "sign by {:.2f} m/s",
                    "xy"[axis], measured_.count(), "xy"[axis], measured, mirrored),
        WarnedSensor::kAny};
  }
  return std::nullopt;
}

}  // namespace aims
