// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/legs/leg_stream.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace aims {
namespace {

constexpr double kUpRate = 0.5;  ///< correction of the upward direction to the specific force [1/s]
constexpr double kLevellingRate = 1.0;  ///< correction of an integrated attitude to gravity [1/s]
constexpr double kMaxStep = 0.5;        ///< longest step that is integrated [s]
constexpr double kMaxTwist = 1000.0;    ///< [m/s], [rad/s]
constexpr Duration kMaxContactAge = kSecond / 5;
constexpr std::size_t kRecentContacts = 64;

/// Whether the feet in contact state velocities of the base that no slip explains.
bool disagree(const std::vector<Eigen::Vector3d>& velocities) {
  constexpr double kApart = 0.3, kPart = 0.5;  // [m/s], of the speed
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& each : velocities)
    mean += each / static_cast<double>(velocities.size());
  return std::ranges::any_of(velocities, [&mean](const Eigen::Vector3d& each) {
    return (each - mean).norm() > kApart + kPart * mean.norm();
  });
}

}  // namespace

void UpDirection::add(const ImuSample& sample) {
  const double force = sample.specific_force.norm();
  if (!sample.angular_velocity.allFinite() || !std::isfinite(force) || !(force > 0.1)) return;
  const Eigen::Vector3d measured = sample.specific_force / force;
  if (!up_) {
    up_ = measured;
  } else {
    const double step = std::clamp(to_seconds(sample.stamp - stamp_), 0.0, kMaxStep);
    const Eigen::Vector3d turned = so3_exp(-step * sample.angular_velocity) * *up_;
    const Eigen::Vector3d corrected = turned + kUpRate * step * (measured - turned);
    up_ = corrected.norm() > 1e-6 ? Eigen::Vector3d(corrected.normalized()) : measured;
  }
  stamp_ = sample.stamp;
}

void LegStream::add_imu(const ImuSample& sample) {
  if (!sample.angular_velocity.allFinite()) return;
  imu_ = sample;
  up_.add(sample);
}

bool LegStream::same_instant(Time a, Time b) const {
  return std::max(a, b) - std::min(a, b) <= config_.half_period;
}

void LegStream::attach(LegOdometrySample& sample) const {
  if (joints_ && same_instant(joints_->stamp, sample.stamp)) {
    sample.joint_position = joints_->position;
    if (joints_->velocity) sample.joint_velocity = *joints_->velocity;
  }
  if (contacts_ && same_instant(contacts_->stamp, sample.stamp)) {
    sample.contact = joints_ ? usable_contacts(*joints_) : contacts_->contact;
    sample.contact_force = contacts_->force;
  }
}

std::optional<Eigen::Vector3d> LegStream::up_in_base() const {
  if (!up_.in_body()) return std::nullopt;
  return config_.T_body_base.rotation.conjugate() * *up_.in_body();
}

/// A driver that leaves the twist empty: the velocity is that of the poses.
void LegStream::fill_twist(LegOdometrySample& sample, EventCounts& counts) {
  const auto before = std::exchange(odometry_, std::pair(sample.stamp, sample.T_odom_base));
  if (!sample.linear_velocity.isZero(0.0) || !sample.angular_velocity.isZero(0.0)) return;
  const double step = before ? to_seconds(sample.stamp - before->first) : 0.0;
  if (!(step > 0.0) || step > kMaxStep) return;
  const Pose moved = before->second.inverse() * sample.T_odom_base;
  const Eigen::Vector3d turned = so3_log(moved.rotation);
  if (moved.translation.isZero(0.0) && turned.isZero(0.0)) return;
  ++counts["legs_twist_by_pose_differences"];
  // In the axes of the base in the middle of the step.
  sample.linear_velocity = so3_exp(-0.5 * turned) * moved.translation / step;
  sample.angular_velocity = turned / step;
}

LegOdometrySample LegStream::add_odometry(LegOdometrySample sample, EventCounts& counts) {
  fill_twist(sample, counts);
  attach(sample);
  if (twist_check_.add(sample)) ++counts["legs_twist_in_odometry_axes_seconds"];
  return sample;
}

LegOdometrySample LegStream::add_twist(LegOdometrySample sample) {
  attach(sample);
  integrate(sample);
  return sample;
}

/// Integrates the twist since the last sample; gravity corrects roll and pitch.
void LegStream::integrate(LegOdometrySample& sample) {
  const std::optional<Eigen::Vector3d> up = up_in_base();
  if (!integrated_) {
    if (up) {
      const auto level = Eigen::Quaterniond::FromTwoVectors(*up, Eigen::Vector3d::UnitZ());
      T_odom_base_.rotation = yaw_rotation(-yaw_of(level)) * level;
    }
    integrated_ = sample.stamp;
  }
  const double step = to_seconds(sample.stamp - *integrated_);
  const bool plausible =
      sample.angular_velocity.norm() < kMaxTwist && sample.linear_velocity.norm() < kMaxTwist;
  if (step > 0.0 && step <= kMaxStep && plausible) {
    Eigen::Quaterniond& rotation = T_odom_base_.rotation;
    rotation = (rotation * so3_exp(sample.angular_velocity * step)).normalized();
    if (up) {
      const Eigen::Vector3d predicted_up = rotation.conjugate() * Eigen::Vector3d::UnitZ();
      rotation = (rotation * so3_exp(kLevellingRate * step * up->cross(predicted_up))).normalized();
    }
    T_odom_base_.translation += rotation * sample.linear_velocity * step;
  }
  integrated_ = std::max(*integrated_, sample.stamp);
  sample.T_odom_base = T_odom_base_;
}

/// Rates from the angles of the last message, if none are recorded.
void LegStream::differentiate(JointReading& reading) {
  if (joints_) stamp_before_ = joints_->stamp;
  if (reading.velocity || !joints_) return;
  const double step = to_seconds(reading.stamp - joints_->stamp);
  if (!(step > 0.0) || step > kMaxStep) return;
  reading.velocity.emplace();
  reading.differenced = true;
  for (std::size_t i = 0; i < reading.position.size(); ++i) {
    (*reading.velocity)[i] = (reading.position[i] - joints_->position[i]) / step;
  }
}

/// The feet in contact whose rates are of that contact: a difference to an angle before touchdown
/// is not.
std::array<bool, kLegCount> LegStream::usable_contacts(const JointReading& joints) const {
  std::array<bool, kLegCount> contact = contacts_->contact;
  if (!joints.differenced) return contact;
  std::array<bool, kLegCount> before{};
  for (const ContactReading& each : recent_contacts_) {
    if (each.stamp <= stamp_before_ + config_.half_period) before = each.contact;
  }
  for (std::size_t leg = 0; leg < contact.size(); ++leg) contact[leg] = contact[leg] && before[leg];
  return contact;
}

/// Whether gyro and contacts are known; otherwise what is missing is counted.
bool LegStream::has_contacts_at(Time stamp, EventCounts& counts) const {
  if (!imu_ || !contacts_) return ++counts["legs_incomplete"], false;
  if (stamp - contacts_->stamp > kMaxContactAge) return ++counts["legs_without_contacts"], false;
  return true;
}

/// Velocity of the base by leg kinematics: the mean over the feet in contact, or the last value
/// without contacts.
std::optional<LegOdometrySample> LegStream::forward_kinematics(const JointReading& joints,
                                                               EventCounts& counts) {
  joints_wait_ = false;
  if (!joints.velocity) return ++counts["legs_incomplete"], std::nullopt;
  if (!has_contacts_at(joints.stamp, counts)) return std::nullopt;
  LegOdometrySample sample;
  sample.stamp = joints.stamp;
  sample.joint_position = joints.position;
  sample.joint_velocity = *joints.velocity;
  sample.contact = usable_contacts(joints);
  sample.contact_force = contacts_->force;
  sample.angular_velocity = config_.T_body_base.rotation.conjugate() * imu_->angular_velocity;
  std::vector<Eigen::Vector3d> velocities;
  for (int leg = 0; leg < kLegCount; ++leg) {
    if (!sample.contact[static_cast<std::size_t>(leg)]) continue;
    const LegMotion motion{Eigen::Vector3d(&sample.joint_position[3 * leg]),
                           Eigen::Vector3d(&sample.joint_velocity[3 * leg]),
                           sample.angular_velocity};
    const bool rolls = config_.foot_model == FootModel::kRolling;
    const Eigen::Vector3d up = up_in_base().value_or(Eigen::Vector3d::UnitZ());
    velocities.push_back(rolls ? velocity_from_rolling_foot(leg, motion, up, config_.geometry)
                               : velocity_from_foot(leg, motion, config_.geometry));
  }
  if (disagree(velocities)) ++counts["feet_in_contact_disagree"];
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& each : velocities) sum += each;
  return finish(std::move(sample), sum, static_cast<int>(velocities.size()), counts);
}

/// The speeds of feet that have none, and the contacts of which they are: a difference over
/// touchdown is no speed of a foot that stands.
bool LegStream::difference_feet(FeetReading& reading, std::array<bool, kLegCount>& contact) {
  const auto before = std::exchange(feet_, std::pair(reading, contact));
  if (reading.has_velocity) return true;
  const double step = before ? to_seconds(reading.stamp - before->first.stamp) : 0.0;
  if (!(step > 0.0) || step > kMaxStep) return false;
  for (std::size_t leg = 0; leg < contact.size(); ++leg) {
    reading.velocity[leg] = (reading.position[leg] - before->first.position[leg]) / step;
    contact[leg] = contact[leg] && before->second[leg];
  }
  return true;
}

std::optional<LegOdometrySample> LegStream::add_feet(FeetReading reading, EventCounts& counts) {
  if (!has_contacts_at(reading.stamp, counts)) return std::nullopt;
  LegOdometrySample sample;
  sample.stamp = reading.stamp;
  sample.contact = contacts_->contact;
  if (!difference_feet(reading, sample.contact)) return ++counts["legs_incomplete"], std::nullopt;
  sample.angular_velocity = config_.T_body_base.rotation.conjugate() * imu_->angular_velocity;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int feet = 0;
  for (std::size_t leg = 0; leg < reading.position.size(); ++leg) {
    if (!sample.contact[leg]) continue;
    sum -= reading.velocity[leg] + sample.angular_velocity.cross(reading.position[leg]);
    ++feet;
  }
  return finish(std::move(sample), sum, feet, counts);
}

/// Completes a sample with the mean velocity of so many feet.
std::optional<LegOdometrySample> LegStream::finish(LegOdometrySample sample,
                                                   const Eigen::Vector3d& sum, int feet,
                                                   EventCounts& counts) {
  if (feet > 0) velocity_ = sum / feet;
  if (feet == 0) ++counts["legs_no_contact"];
  if (!velocity_.allFinite()) {
    velocity_.setZero();
    return ++counts["legs_not_finite"], std::nullopt;
  }
  sample.linear_velocity = velocity_;
  integrate(sample);
  return sample;
}

std::optional<LegOdometrySample> LegStream::add_joints(JointReading reading, EventCounts& counts) {
  differentiate(reading);
  if (config_.source != LegSource::kKinematics) {
    joints_ = std::move(reading);
    return std::nullopt;
  }
  std::optional<LegOdometrySample> sample;
  if (joints_wait_)
    sample = forward_kinematics(*joints_, counts);  // without contacts of the same instant
  joints_ = std::move(reading);
  joints_wait_ = true;
  if (sample) return sample;
  if (contacts_ && same_instant(contacts_->stamp, joints_->stamp))
    return forward_kinematics(*joints_, counts);
  return std::nullopt;
}

std::optional<LegOdometrySample> LegStream::add_contacts(const ContactReading& reading,
                                                         EventCounts& counts) {
  contacts_ = reading;
  recent_contacts_.push_back(reading);
  if (recent_contacts_.size() > kRecentContacts) recent_contacts_.pop_front();
  if (config_.source != LegSource::kKinematics || !joints_wait_) return std::nullopt;
  if (!same_instant(reading.stamp, joints_->stamp)) return std::nullopt;
  return forward_kinematics(*joints_, counts);
}

}  // namespace aims
