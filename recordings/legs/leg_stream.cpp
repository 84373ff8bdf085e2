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

/// Longer without a foot in contact the robot is carried or lies.
constexpr Duration kMaxFlight = kSecond / 2;
constexpr std::size_t kRecentContacts = 512;
constexpr std::size_t kMostWaiting = 512;  ///< joints

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

LegStream::LegStream(const LegStreamConfig& config)
    : config_(config),
      check_(config.source == LegSource::kKinematics ? config.geometry : LegGeometry(),
             config.without_contacts),
      differences_(config.geometry) {}

void LegStream::add_imu(const ImuSample& sample) {
  if (!sample.angular_velocity.allFinite()) return;
  imu_ = sample;
  up_.add(sample);
  check_imu(sample);
}

void LegStream::check_imu(const ImuSample& sample) {
  const Pose T_base_body = config_.T_body_base.inverse();
  ImuSample in_base = sample;
  in_base.angular_velocity = T_base_body.rotation * sample.angular_velocity;
  in_base.specific_force = T_base_body.rotation * sample.specific_force;
  check_.add_imu(in_base, T_base_body.translation);
}

std::vector<ReadingWarning> LegStream::warnings() const {
  std::vector<ReadingWarning> found = check_.warnings();
  if (auto rates = rate_check_.warning()) {
    // They spoil the velocities of feet that joints tell.
    if (config_.source == LegSource::kKinematics) {
      std::erase_if(found, [](const ReadingWarning& each) {
        return each.kind != WarningKind::kDeadLegSensor;
      });
    }
    found.insert(found.begin(), std::move(*rates));
  }
  if (auto twist = twist_check_.warning()) found.push_back(std::move(*twist));
  return found;
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
    sample.contact =
        joints_ ? usable_contacts(*joints_, *contacts_, stamp_before_) : contacts_->contact;
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

/// A driver that leaves the pose empty: it is that of the twist.
void LegStream::fill_pose(LegOdometrySample& sample, EventCounts& counts) {
  constexpr double kMoved = 0.1;    // by the twist, while the pose is the same [m]
  constexpr double kCatchUp = 1.0;  // [s]
  const Eigen::Vector3d position = sample.T_odom_base.translation;
  if (!first_position_) first_position_ = position;
  pose_moves_ = pose_moves_ || (!pose_by_twist_ && position != *first_position_);
  if (pose_moves_) return;
  LegOdometrySample moved = sample;
  integrate(moved);
  if (!pose_by_twist_ && moved.T_odom_base.translation.norm() > kMoved) {
    pose_by_twist_ = sample.stamp;
    unmoved_ = moved.T_odom_base.translation;
  }
  if (!pose_by_twist_) return;
  ++counts["legs_pose_by_twist"];
  sample.T_odom_base = moved.T_odom_base;
  // What it has not moved until then it makes up for slowly.
  const double part = to_seconds(sample.stamp - *pose_by_twist_) / kCatchUp;
  sample.T_odom_base.translation -= std::clamp(1.0 - part, 0.0, 1.0) * unmoved_;
}

LegOdometrySample LegStream::add_odometry(LegOdometrySample sample, EventCounts& counts) {
  fill_twist(sample, counts);
  fill_pose(sample, counts);
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

/// Whether there are no rates, or a driver has filled in none: not finite, or all zero from the
/// start on while the angles change.
bool LegStream::lacks_rates(const JointReading& reading) const {
  if (!reading.velocity) return true;
  const auto& rates = *reading.velocity;
  if (!std::ranges::all_of(rates, [](double each) { return std::isfinite(each); })) return true;
  return !rates_seen_ && joints_ && joints_->position != reading.position;
}

/// A leg with an angle that is no number keeps its last angles, and its foot does not count.
void LegStream::keep_unknown(JointReading& reading, EventCounts& counts) const {
  constexpr std::size_t kPerLeg = 3;
  for (std::size_t leg = 0; leg < reading.unknown.size(); ++leg) {
    for (std::size_t i = kPerLeg * leg; i < kPerLeg * (leg + 1); ++i) {
      reading.unknown[leg] = reading.unknown[leg] || !std::isfinite(reading.position[i]);
    }
    if (!reading.unknown[leg]) continue;
    for (std::size_t i = kPerLeg * leg; i < kPerLeg * (leg + 1); ++i) {
      reading.position[i] = joints_ ? joints_->position[i] : 0.0;
      if (reading.velocity) (*reading.velocity)[i] = 0.0;
    }
  }
  const auto legs = std::ranges::count(reading.unknown, true);
  if (legs > 0) ++counts["joints_not_finite"];
}

/// Rates from the angles of the last message, if none are recorded.
void LegStream::differentiate(JointReading& reading, EventCounts& counts) {
  if (joints_) stamp_before_ = joints_->stamp;
  const auto is_rate = [](double each) { return std::isfinite(each) && each != 0.0; };
  rates_seen_ =
      rates_seen_ || (reading.velocity && std::ranges::any_of(*reading.velocity, is_rate));
  if (!lacks_rates(reading)) return;
  if (reading.velocity) ++counts["joint_rates_empty"];
  reading.velocity.reset();
  if (!joints_) return;
  const double step = to_seconds(reading.stamp - joints_->stamp);
  if (!(step > 0.0) || step > kMaxStep) return;
  reading.velocity.emplace();
  reading.differenced = true;
  for (std::size_t i = 0; i < reading.position.size(); ++i) {
    (*reading.velocity)[i] = (reading.position[i] - joints_->position[i]) / step;
  }
}

/// The last contacts of that instant or before it; else the first ones.
const ContactReading* LegStream::contacts_at(Time stamp) const {
  const ContactReading* found = nullptr;
  for (const ContactReading& each : recent_contacts_) {
    if (each.stamp > stamp + config_.half_period) continue;
    if (found == nullptr || each.stamp >= found->stamp) found = &each;
  }
  if (found == nullptr && !recent_contacts_.empty()) return &recent_contacts_.front();
  return found;
}

/// The feet in contact whose rates are of that contact: a difference to an angle before touchdown
/// is not.
std::array<bool, kLegCount> LegStream::usable_contacts(const JointReading& joints,
                                                       const ContactReading& contacts,
                                                       Time stamp_before) const {
  std::array<bool, kLegCount> contact = contacts.contact;
  for (std::size_t leg = 0; leg < contact.size(); ++leg) {
    contact[leg] = contact[leg] && !joints.unknown[leg];
  }
  if (!joints.differenced) return contact;
  std::array<bool, kLegCount> before{};
  for (const ContactReading& each : recent_contacts_) {
    if (each.stamp <= stamp_before + config_.half_period) before = each.contact;
  }
  for (std::size_t leg = 0; leg < contact.size(); ++leg) contact[leg] = contact[leg] && before[leg];
  return contact;
}

/// Whether gyro and contacts are known; otherwise what is missing is counted.
bool LegStream::has_contacts(const std::optional<ImuSample>& imu, const ContactReading* contacts,
                             Time stamp, EventCounts& counts) const {
  if (!imu || contacts == nullptr) return ++counts["legs_incomplete"], false;
  if (!config_.contacts_on_change && stamp - contacts->stamp > kMaxContactAge) {
    return ++counts["legs_without_contacts"], false;
  }
  return true;
}

/// Velocity of the base by leg kinematics: the mean over the feet in contact, or the last value
/// during a short flight.
std::optional<LegOdometrySample> LegStream::forward_kinematics(const WaitingJoints& waiting,
                                                               EventCounts& counts) {
  const JointReading& joints = waiting.reading;
  if (!joints.velocity) return ++counts["legs_incomplete"], std::nullopt;
  const ContactReading* contacts = contacts_at(joints.stamp);
  if (!has_contacts(waiting.imu, contacts, joints.stamp, counts)) return std::nullopt;
  LegOdometrySample sample;
  sample.stamp = joints.stamp;
  sample.joint_position = joints.position;
  sample.joint_velocity = *joints.velocity;
  sample.contact = usable_contacts(joints, *contacts, waiting.before);
  sample.contact_force = contacts->force;
  sample.angular_velocity =
      config_.T_body_base.rotation.conjugate() * waiting.imu->angular_velocity;
  std::vector<Eigen::Vector3d> velocities;
  std::vector<StandingFoot> feet;
  for (int leg = 0; leg < kLegCount; ++leg) {
    if (!sample.contact[static_cast<std::size_t>(leg)]) continue;
    const LegMotion motion{Eigen::Vector3d(&sample.joint_position[3 * leg]),
                           Eigen::Vector3d(&sample.joint_velocity[3 * leg]),
                           sample.angular_velocity};
    feet.push_back({leg, foot_in_base(leg, motion.q, config_.geometry),
                    foot_jacobian(leg, motion.q, config_.geometry) * motion.rate});
    const bool rolls = config_.foot_model == FootModel::kRolling;
    const Eigen::Vector3d up = up_in_base().value_or(Eigen::Vector3d::UnitZ());
    velocities.push_back(rolls ? velocity_from_rolling_foot(leg, motion, up, config_.geometry)
                               : velocity_from_foot(leg, motion, config_.geometry));
  }
  if (disagree(velocities)) ++counts["feet_in_contact_disagree"];
  check_.add_joints(joints.position, joints.unknown);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& each : velocities) sum += each;
  check_.add_feet(feet, sum / static_cast<double>(std::max<std::size_t>(1, feet.size())),
                  joints.differenced);
  const auto rises = differences_.add(sample);
  if (joints.differenced) check_.add_rises(rises);
  return finish(std::move(sample), sum, static_cast<int>(velocities.size()), counts);
}

/// The speeds of feet that have none, and the contacts of which they are: a difference over
/// touchdown is no speed of a foot that stands.
bool LegStream::difference_feet(FeetReading& reading, std::array<bool, kLegCount>& contact,
                                EventCounts& counts) {
  const auto before = std::exchange(feet_, std::pair(reading, contact));
  const auto is_zero = [](const Eigen::Vector3d& each) { return each.isZero(0.0); };
  speeds_seen_ = speeds_seen_ || !std::ranges::all_of(reading.velocity, is_zero);
  const bool empty = !speeds_seen_ && before && before->first.position != reading.position;
  if (reading.has_velocity && !empty) return true;
  if (reading.has_velocity) ++counts["joint_rates_empty"];
  const double step = before ? to_seconds(reading.stamp - before->first.stamp) : 0.0;
  if (!(step > 0.0) || step > kMaxStep) return false;
  for (std::size_t leg = 0; leg < contact.size(); ++leg) {
    reading.velocity[leg] = (reading.position[leg] - before->first.position[leg]) / step;
    contact[leg] = contact[leg] && before->second[leg];
  }
  return true;
}

std::optional<LegOdometrySample> LegStream::add_feet(FeetReading reading, EventCounts& counts) {
  if (!has_contacts(imu_, contacts_ ? &*contacts_ : nullptr, reading.stamp, counts)) {
    return std::nullopt;
  }
  LegOdometrySample sample;
  sample.stamp = reading.stamp;
  sample.contact = contacts_->contact;
  for (std::size_t leg = 0; leg < sample.contact.size(); ++leg) {
    sample.contact[leg] = sample.contact[leg] && reading.position[leg].allFinite();
  }
  if (!difference_feet(reading, sample.contact, counts))
    return ++counts["legs_incomplete"], std::nullopt;
  sample.angular_velocity = config_.T_body_base.rotation.conjugate() * imu_->angular_velocity;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int feet = 0;
  std::vector<StandingFoot> standing;
  for (std::size_t leg = 0; leg < reading.position.size(); ++leg) {
    if (!sample.contact[leg]) continue;
    standing.push_back({static_cast<int>(leg), reading.position[leg], reading.velocity[leg]});
    sum -= reading.velocity[leg] + sample.angular_velocity.cross(reading.position[leg]);
    ++feet;
  }
  check_.add_feet(standing, sum / std::max(1, feet));
  return finish(std::move(sample), sum, feet, counts);
}

/// Completes a sample with the mean velocity of so many feet.
std::optional<LegOdometrySample> LegStream::finish(LegOdometrySample sample,
                                                   const Eigen::Vector3d& sum, int feet,
                                                   EventCounts& counts) {
  if (feet > 0) {
    velocity_ = sum / feet;
    last_contact_ = sample.stamp;
  } else {
    ++counts["legs_no_contact"];
    if (last_contact_ && sample.stamp - *last_contact_ > kMaxFlight) {
      return ++counts["legs_in_the_air"], std::nullopt;
    }
  }
  if (!velocity_.allFinite()) {
    velocity_.setZero();
    return ++counts["legs_not_finite"], std::nullopt;
  }
  sample.linear_velocity = velocity_;
  integrate(sample);
  return sample;
}

std::optional<LegOdometrySample> LegStream::add_joints(JointReading reading, EventCounts& counts) {
  keep_unknown(reading, counts);
  if (rates_seen_) rate_check_.add(reading);  // zeros until then are none
  // No rate is a difference to angles of the same stamp.
  if (joints_ && reading.stamp == joints_->stamp && lacks_rates(reading)) {
    return ++counts["joints_stamp_repeated"], std::nullopt;
  }
  differentiate(reading, counts);
  if (config_.source == LegSource::kKinematics) {
    waiting_.push_back({reading, imu_, stamp_before_});
  }
  joints_ = std::move(reading);
  return next(counts);
}

std::optional<LegOdometrySample> LegStream::add_contacts(const ContactReading& reading,
                                                         EventCounts& counts) {
  contacts_ = reading;
  recent_contacts_.push_back(reading);
  if (recent_contacts_.size() > kRecentContacts) recent_contacts_.pop_front();
  return next(counts);
}

/// Whether contacts of the instant of these joints are there, or are no longer waited for.
bool LegStream::is_due(const JointReading& joints) const {
  if (contacts_ && same_instant(contacts_->stamp, joints.stamp)) return true;
  const bool passed = contacts_ && contacts_->stamp > joints.stamp;
  const bool last = waiting_.size() == 1;
  const Duration waited = waiting_.back().reading.stamp - joints.stamp;
  return passed || waiting_.size() > kMostWaiting ||
         (!last && std::abs(waited) >= config_.contact_wait);
}

std::optional<LegOdometrySample> LegStream::next(EventCounts& counts) {
  while (!waiting_.empty() && is_due(waiting_.front().reading)) {
    const WaitingJoints waiting = std::move(waiting_.front());
    waiting_.pop_front();
    if (auto sample = forward_kinematics(waiting, counts)) return sample;
  }
  return std::nullopt;
}

}  // namespace aims
