// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/legs/leg_check.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace aims {
namespace {

constexpr int kFewestSamples = 8;         ///< of a window
constexpr int kFewestWindows = 8;         ///< that a judgement needs
constexpr double kTurning = 0.15;         ///< of a window that counts [rad/s]
constexpr double kLeastWeight = 0.01;     ///< squared distance of feet that show a turn [m^2]
constexpr double kAccelerating = 0.1;     ///< change of velocity that counts [m/s]
constexpr std::size_t kStartWindows = 3;  ///< in which a robot starts or stops
constexpr double kStarting = 0.25;        ///< change of velocity of one that does [m/s]
constexpr int kFewestStarts = 2;
constexpr double kWalking = 0.15;   ///< [m/s]
constexpr double kOpposite = -0.5;  ///< correlation
constexpr double kRelated = 0.5;    ///< below feet and gyro have nothing in common
constexpr double kClear = 0.7;      ///< correlation whose scale is judged
/// Of feet to the IMU; 0.7 on a real robot, whose feet count as standing while they lift off.
constexpr double kLeastScale = 0.55, kMostScale = 1.7;
/// Of the IMU whose scale is judged: single samples at a lower rate miss impacts of the feet. Of a
/// real robot's 400 Hz every third sample serves; every fourth one made the scale 0.5.
constexpr double kLeastRate = 130.0;                          ///< [Hz]
constexpr double kLeastDegrees = 30.0, kMostDegrees = 110.0;  ///< of deg/s: 57
constexpr int kFewestStances = 100;                           ///< samples
constexpr double kLeastDepth = 0.35;  ///< of a foot in contact below its hip, of the leg's length
constexpr double kStraight = 0.95;    ///< no robot walks on straight knees
constexpr double kMostApart = 0.5;    ///< in front of or behind its hip
// Of a foot in contact against the base, at most 0.06 on a real robot; of an error of 0.3 rad of a
// thigh 0.24 to 0.36.
constexpr double kMostSlope = 0.2;
constexpr int kFewestSlopes = 12;   ///< windows
constexpr double kMostSide = 0.12;  ///< left feet below right ones, of the leg's length; likewise

bool is_scale(double scale) { return scale > kLeastScale && scale < kMostScale; }

bool is_degrees(double scale) { return scale > kLeastDegrees && scale < kMostDegrees; }

}  // namespace

void LegCheck::add_imu(const ImuSample& sample, const Eigen::Vector3d& place) {
  const ForceStep step = signs_.add_imu(sample, place);
  if (step == ForceStep::kClosedWindow) close();
  if (step != ForceStep::kBeganAnew) return;
  window_ = {};
  recent_.clear();
}

void LegCheck::add_joints(const std::array<double, kJointCount>& angles,
                          const std::array<bool, kLegCount>& unknown) {
  if (!window_.angles) window_.angles = angles;
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const bool kept = angles[i] == (*window_.angles)[i] && !unknown[i / 3];
    window_.moved[i] = window_.moved[i] || !kept;
  }
}

void LegCheck::add_feet(const std::vector<StandingFoot>& feet, const Eigen::Vector3d& velocity,
                        bool differenced) {
  const SignedForce& imu = signs_.measured();
  if (!imu.has_begun() || feet.empty() || !velocity.allFinite()) return;
  signs_.add_legs(velocity);
  ++window_.legs;
  window_.speed += velocity.norm();
  window_.forward += velocity.x();
  const Eigen::Vector3d& turning = imu.turning();
  const Eigen::Vector3d up = imu.R_world_base().conjugate() * Eigen::Vector3d::UnitZ();
  for (const StandingFoot& foot : feet) {
    const Eigen::Vector3d from_hip = foot.position - hip_in_base(foot.leg, geometry_);
    Stance& stance = window_.stances[static_cast<std::size_t>(foot.leg)];
    ++stance.samples;
    stance.depth -= up.dot(from_hip);
    stance.apart += from_hip.x();
    stance.below -= from_hip.z();
    if (!differenced) add_rises({{foot.leg, -(foot.velocity + turning.cross(foot.position)).z()}});
  }
  for (std::size_t i = 1; i < feet.size(); ++i) {
    // The velocities of feet that stand differ by the turning of the base alone.
    const Eigen::Vector3d apart = feet[i].position - feet[0].position;
    const Eigen::Vector3d faster = feet[i].velocity - feet[0].velocity;
    ++window_.pairs;
    window_.gyro += turning.z();
    window_.by_feet += Eigen::Vector2d(apart.y() * faster.x(), -apart.x() * faster.y());
    window_.weight += Eigen::Vector2d(apart.y() * apart.y(), apart.x() * apart.x());
  }
}

void LegCheck::add_rises(const std::vector<FootRise>& rises) {
  for (const FootRise& each : rises) {
    Stance& stance = window_.stances[static_cast<std::size_t>(each.leg)];
    stance.rise += each.speed;
    ++stance.rises;
  }
}

void LegCheck::close() {
  compare_turning();
  compare_velocities();
  if (window_.legs >= kFewestSamples && window_.speed > kWalking * window_.legs) {
    count_walking();
    compare_slopes();
  }
  window_ = {};
}

void LegCheck::count_walking() {
  walked_ += window_.angles ? 1 : 0;
  for (std::size_t i = 0; i < frozen_.size(); ++i) {
    frozen_[i] += window_.angles && !window_.moved[i] ? 1 : 0;
  }
  for (std::size_t leg = 0; leg < stances_.size(); ++leg) {
    stances_[leg].samples += window_.stances[leg].samples;
    stances_[leg].depth += window_.stances[leg].depth;
    stances_[leg].apart += window_.stances[leg].apart;
    stances_[leg].below += window_.stances[leg].below;
  }
}

void LegCheck::compare_slopes() {
  constexpr int kFewestOfStance = 4;  // samples
  const double forward = window_.forward / window_.legs;
  if (std::abs(forward) < kWalking) return;
  for (std::size_t leg = 0; leg < slopes_.size(); ++leg) {
    const Stance& stance = window_.stances[leg];
    if (stance.rises >= kFewestOfStance) slopes_[leg].add(stance.rise / stance.rises, forward);
  }
}

void LegCheck::compare_turning() {
  if (window_.pairs < kFewestSamples) return;
  const double gyro = window_.gyro / window_.pairs;
  if (std::abs(gyro) < kTurning) return;
  for (int axis = 0; axis < 2; ++axis) {
    if (window_.weight[axis] < kLeastWeight * window_.pairs) continue;
    turns_[static_cast<std::size_t>(axis)].add(window_.by_feet[axis] / window_.weight[axis], gyro);
  }
}

void LegCheck::compare_velocities() {
  compare_direction();
  const auto& change = signs_.measured().change();
  if (!change) return;
  for (int axis = 0; axis < 2; ++axis) {
    if (std::abs(change->by_force[axis]) < kAccelerating) continue;
    changes_[static_cast<std::size_t>(axis)].add(change->by_legs[axis], change->by_force[axis]);
  }
}

/// Compares the change of velocity over some windows, as where the robot starts or stops.
void LegCheck::compare_direction() {
  const auto& now = signs_.measured().window();
  if (!now) return recent_.clear();
  recent_.push_back(*now);
  if (recent_.size() <= kStartWindows) return;
  const Eigen::Vector2d by_legs = (now->by_legs - recent_.front().by_legs).head<2>();
  const Eigen::Vector2d by_force = (now->by_force - recent_.front().by_force).head<2>();
  recent_.pop_front();
  if (by_legs.norm() < kStarting) return;
  recent_ = {*now};
  const double cosine = by_legs.normalized().dot(by_force.normalized());
  const double ratio = by_force.norm() / by_legs.norm();
  if (ratio < kLeastScale || ratio > 1.0 / kLeastScale || std::abs(cosine) < kClear) return;
  ++(cosine > 0.0 ? along_ : against_);
}

/// The legs with joints that stand still while the robot walks; not those of robots without such a
/// joint.
std::vector<std::string> LegCheck::frozen_legs() const {
  constexpr std::array<std::string_view, 3> kJoints = {"abduction", "hip", "knee"};
  std::array<std::array<bool, 3>, kLegCount> frozen{};
  std::array<int, 3> legs_with{};
  for (std::size_t i = 0; i < frozen_.size(); ++i) {
    frozen[i / 3][i % 3] = 2 * frozen_[i] > walked_;
    legs_with[i % 3] += frozen[i / 3][i % 3] ? 1 : 0;
  }
  std::vector<std::string> legs;
  for (std::size_t leg = 0; leg < frozen.size(); ++leg) {
    std::vector<std::string_view> joints;
    for (std::size_t joint = 0; joint < kJoints.size(); ++joint) {
      const bool is_joint = legs_with[joint] < kLegCount;
      if (frozen[leg][joint] && is_joint) joints.push_back(kJoints[joint]);
    }
    if (std::ranges::count(frozen[leg], true) == 3) {
      legs.emplace_back(kLegNames[leg]);
    } else if (!joints.empty()) {
      legs.push_back(fmt::format("{} ({})", kLegNames[leg], fmt::join(joints, ", ")));
    }
  }
  return legs;
}

/// Warns of joints whose angles stand still while the robot walks; whether there are some.
bool LegCheck::check_frozen(std::vector<ReadingWarning>& found) const {
  const std::vector<std::string> legs = frozen_legs();
  if (legs.empty() || walked_ < kFewestWindows) return false;
  found.push_back({"angles of a leg stand still",
                   fmt::format("the joint angles of {} do not change while the robot walks: the "
                               "driver does not read them, or sends the last ones again",
                               fmt::join(legs, ", ")),
                   WarnedSensor::kLegs, WarningKind::kDeadLegSensor});
  return true;
}

/// Warns of feet that never stand while the robot walks.
void LegCheck::check_idle(std::vector<ReadingWarning>& found) const {
  constexpr int kOften = 20;  // times as many samples of another foot
  if (!(geometry_.thigh + geometry_.calf > 0.0)) return;
  const int most = std::ranges::max_element(stances_, {}, &Stance::samples)->samples;
  std::vector<std::string_view> feet;
  for (std::size_t leg = 0; leg < stances_.size(); ++leg) {
    if (kOften * stances_[leg].samples < most && !without_contacts_[leg]) {
      feet.emplace_back(kLegNames[leg]);
    }
  }
  if (feet.empty() || most < kFewestStances) return;
  found.push_back({"a foot never stands",
                   fmt::format("no contact of {} while the robot walks: is a sensor dead, or the "
                               "load below the threshold (contact_threshold, contacts_field)? Only "
                               "the other feet serve",
                               fmt::join(feet, ", ")),
                   WarnedSensor::kLegs, WarningKind::kDeadLegSensor});
}

/// Warns of legs that no robot walks on.
void LegCheck::check_stances(std::vector<ReadingWarning>& found) const {
  const double length = geometry_.thigh + geometry_.calf;
  std::vector<std::string> odd;
  for (std::size_t leg = 0; leg < stances_.size(); ++leg) {
    const Stance& stance = stances_[leg];
    if (stance.samples < kFewestStances || !(length > 0.0)) continue;
    const double depth = stance.depth / stance.samples;
    const double apart = stance.apart / stance.samples;
    if (depth < kLeastDepth * length || depth > kStraight * length) {
      odd.push_back(fmt::format("{} {:.2f} m below its hip", kLegNames[leg], depth));
    } else if (std::abs(apart) > kMostApart * length) {
      odd.push_back(fmt::format("{} {:.2f} m {} its hip", kLegNames[leg], std::abs(apart),
                                apart > 0.0 ? "in front of" : "behind"));
    }
  }
  if (odd.empty()) return;
  found.push_back({"joint angles do not fit a walking robot",
                   fmt::format("by the joint angles the feet in contact are, in the mean, {}, with "
                               "legs of {:.2f} m: the zero, a sign or the unit of the joints is "
                               "another one, or their order (joint_names) or lengths "
                               "(leg_geometry)",
                               fmt::join(odd, ", "), length),
                   WarnedSensor::kLegs});
}

/// Warns of feet that move against the base on a slope.
void LegCheck::check_slopes(std::vector<ReadingWarning>& found) const {
  if (!(geometry_.thigh + geometry_.calf > 0.0)) return;
  std::vector<std::string> odd;
  for (std::size_t leg = 0; leg < slopes_.size(); ++leg) {
    const double slope = slopes_[leg].scale();
    if (slopes_[leg].count() < kFewestSlopes || std::abs(slope) < kMostSlope) continue;
    odd.push_back(fmt::format("{} {:.2f}", kLegNames[leg], slope));
  }
  if (odd.empty()) return;
  found.push_back(
      {"joint angles do not fit a walking robot",
       fmt::format("by the joint angles feet in contact move on a slope against the "
                   "base, {} m up for each m ahead: the zero of the hip is off by "
                   "about as many rad, or of the knee by twice as many (or feet count as "
                   "standing while they lift off, or the robot climbs stairs with a "
                   "level trunk)",
                   fmt::join(odd, ", ")),
       WarnedSensor::kLegs});
}

/// Warns of a base that leans over to one side by its legs.
void LegCheck::check_sides(std::vector<ReadingWarning>& found) const {
  const double length = geometry_.thigh + geometry_.calf;
  std::array<double, 2> below{};  // left, right
  for (std::size_t leg = 0; leg < stances_.size(); ++leg) {
    if (stances_[leg].samples < kFewestStances) return;
    below[leg % 2] += 0.5 * stances_[leg].below / stances_[leg].samples;
  }
  if (!(length > 0.0) || std::abs(below[0] - below[1]) < kMostSide * length) return;
  found.push_back({"joint angles do not fit a walking robot",
                   fmt::format("by the joint angles the feet in contact are, in the mean, {:.2f} m "
                               "(left) and {:.2f} m (right) below the hips: the zero or a sign of "
                               "the abductions is another one",
                               below[0], below[1]),
                   WarnedSensor::kLegs});
}

/// Warns of feet that turn against the base otherwise than the gyro says.
void LegCheck::check_turning(std::vector<ReadingWarning>& found) const {
  const SignalAgreement &x = turns_[0], &y = turns_[1];
  if (x.count() < kFewestWindows || y.count() < kFewestWindows) return;
  const double along_x = x.correlation(), along_y = y.correlation();
  std::string cause;
  if (along_x < kOpposite && along_y < kOpposite) {
    cause =
        "z of the gyro or all joints have the wrong sign, or the legs are in the opposite order "
        "(joint_names, foot_names)";
  } else if (along_x < kOpposite && along_y > kClear) {
    cause = "the legs of the left and the right are exchanged (joint_names, foot_names)";
  } else if (along_x > kClear && along_y < kOpposite) {
    cause =
        "front and rear legs are exchanged (joint_names, foot_names), or the sign of the "
        "abductions is wrong";
  } else if (std::min(along_x, along_y) < kRelated) {
    cause =
        "the order of the legs (joint_names, foot_names), or the sign or zero of joints is "
        "wrong, or contacts are late";
  } else if (std::min(along_x, along_y) < kClear || (is_scale(x.scale()) && is_scale(y.scale()))) {
    return;
  } else if (is_degrees(1.0 / x.scale()) && is_degrees(1.0 / y.scale())) {
    cause =
        "the gyro is in deg/s: set recording.gyro_unit=deg/s (of a table: gyro_unit: deg/s)"
        "; or the joints are in rad, though recording.joint_unit is deg";
  } else if (is_degrees(x.scale()) && is_degrees(y.scale())) {
    cause = "the rates of the joints are in deg/s";
  } else {
    cause =
        "the scale of the gyro or the rates, zero or lengths (leg_geometry) of the legs are "
        "wrong, or contacts are late";
  }
  found.push_back(
      {"feet in contact contradict the gyro",
       fmt::format("in turns the feet in contact and the gyro contradict each other: "
                   "{:.2g} and {:.2g} times the gyro's rate along x and y, correlation "
                   "{:.2f} and {:.2f} over {} half seconds: {}",
                   x.scale(), y.scale(), along_x, along_y, std::min(x.count(), y.count()), cause),
       WarnedSensor::kLegs, WarningKind::kFeetAgainstGyro});
}

/// Warns of legs whose velocity changes otherwise than the accelerometer says.
void LegCheck::check_acceleration(std::vector<ReadingWarning>& found) const {
  const bool fast = signs_.measured().imu_rate() > kLeastRate;
  for (std::size_t axis = 0; axis < changes_.size(); ++axis) {
    const SignalAgreement& change = changes_[axis];
    if (change.count() < kFewestWindows) continue;
    const double correlation = change.correlation();
    const bool scaled = fast && correlation > kClear && !is_scale(change.scale());
    if (correlation > kOpposite && !scaled) continue;
    const char name = "xy"[axis];
    const std::string cause =
        scaled ? "the lengths (leg_geometry), the zero or the unit of the joints, or the IMU is "
                 "wrong, or contacts are late"
               : fmt::format(
                     "{} of the accelerometer, or the joints that move the feet along {}, "
                     "have the wrong sign",
                     name, name);
    found.push_back({"legs contradict the accelerometer",
                     fmt::format("the velocity along {} by the legs changes by {:.2g} times what "
                                 "the accelerometer says (correlation {:.2f} over {} half "
                                 "seconds): {}",
                                 name, change.scale(), correlation, change.count(), cause),
                     WarnedSensor::kLegs});
  }
}

/// Warns of legs that start and stop in the opposite direction.
void LegCheck::check_direction(std::vector<ReadingWarning>& found) const {
  if (against_ < kFewestStarts || 3 * along_ > against_ || !signs_.mirrored_x_fits()) return;
  found.push_back({"legs walk against the accelerometer",
                   fmt::format("in {} of {} starts and stops the velocity by the legs changes in "
                               "the opposite direction of what the accelerometer says: legs are "
                               "exchanged (joint_names, foot_names), joints have another sign, or "
                               "the IMU is mounted the other way round (T_imu_base)",
                               against_, along_ + against_),
                   WarnedSensor::kLegs});
}

std::vector<ReadingWarning> LegCheck::warnings() const {
  std::vector<ReadingWarning> found;
  if (check_frozen(found)) return found;  // which spoils all else
  check_idle(found);
  if (found.empty()) check_stances(found);
  if (found.empty()) check_slopes(found);
  if (found.empty()) check_sides(found);
  check_turning(found);
  const std::size_t before = found.size();
  check_acceleration(found);
  if (found.empty()) check_direction(found);
  if (auto sign = signs_.warning(); sign && found.size() == before) {
    found.push_back(std::move(*sign));
  }
  return found;
}

}  // namespace aims
