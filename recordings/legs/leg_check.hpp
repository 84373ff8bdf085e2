// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "core/leg_kinematics.hpp"
#include "core/measurements.hpp"
#include "recordings/legs/axis_signs.hpp"
#include "recordings/legs/foot_differences.hpp"
#include "recordings/legs/signal_agreement.hpp"
#include "recordings/reading_notes.hpp"

namespace aims {

/// A foot in contact, in base axes, against the base.
struct StandingFoot {
  int leg = 0;
  Eigen::Vector3d position;  ///< [m]
  Eigen::Vector3d velocity;  ///< [m/s]
};

/// Checks legs and IMU by each other over half seconds of a walk, since single samples of feet say
/// little: feet in contact lie below the hips, they turn against the base as the gyro says, and
/// their velocity changes as the accelerometer says.
class LegCheck {
 public:
  /// Without lengths of the legs it is not judged where the feet are.
  /// `without_contacts`: feet of which it is known that no contact of them is used.
  explicit LegCheck(const LegGeometry& geometry,
                    const std::array<bool, kLegCount>& without_contacts = {})
      : geometry_(geometry), without_contacts_(without_contacts) {}

  /// In base axes; `place` is that of the IMU in the base.
  void add_imu(const ImuSample& sample, const Eigen::Vector3d& place);
  /// The angles of all joints, before the feet of that instant; `unknown`: legs that keep their
  /// last ones, since theirs are no numbers.
  void add_joints(const std::array<double, kJointCount>& angles,
                  const std::array<bool, kLegCount>& unknown = {});
  /// The feet in contact and the velocity of the base that they state, in base axes; `differenced`:
  /// by differences of angles, of which some reach over touchdown; `add_rises` adds how they rise.
  void add_feet(const std::vector<StandingFoot>& feet, const Eigen::Vector3d& velocity,
                bool differenced = false);
  /// By central differences, where the velocities of `add_feet` are differenced.
  void add_rises(const std::vector<FootRise>& rises);

  /// What contradicts; nothing with too little motion.
  std::vector<ReadingWarning> warnings() const;

 private:
  /// Sums over feet in contact.
  struct Stance {
    int samples = 0;
    double depth = 0.0;  ///< below the hip [m]
    double apart = 0.0;  ///< in front of it [m]
    double below = 0.0;  ///< it, along z of the base [m]
    double rise = 0.0;   ///< velocity of the base along its z, by this foot [m/s]
    int rises = 0;       ///< samples of it
  };
  /// Sums over half a second.
  struct Window {
    int legs = 0, pairs = 0;
    double speed = 0.0;    ///< by the legs, without direction
    double forward = 0.0;  ///< by the legs, along x of the base
    double gyro = 0.0;     ///< turn rate about z
    /// Turn rate about z by what pairs of feet do along x and y, weighted, and the weights.
    Eigen::Vector2d by_feet = Eigen::Vector2d::Zero(), weight = Eigen::Vector2d::Zero();
    std::array<Stance, kLegCount> stances;
    std::optional<std::array<double, kJointCount>> angles;  ///< the first
    std::array<bool, kJointCount> moved{};                  ///< the angle changed, or may have
  };
  using Velocities = SignedForce::Velocities;
  void close();
  void compare_turning();
  void compare_velocities();
  void compare_direction();
  void compare_slopes();
  void count_walking();
  std::vector<std::string> frozen_legs() const;
  bool check_frozen(std::vector<ReadingWarning>& found) const;
  void check_idle(std::vector<ReadingWarning>& found) const;
  void check_stances(std::vector<ReadingWarning>& found) const;
  void check_slopes(std::vector<ReadingWarning>& found) const;
  void check_sides(std::vector<ReadingWarning>& found) const;
  void check_turning(std::vector<ReadingWarning>& found) const;
  void check_acceleration(std::vector<ReadingWarning>& found) const;
  void check_direction(std::vector<ReadingWarning>& found) const;

  LegGeometry geometry_;
  std::array<bool, kLegCount> without_contacts_;
  AxisSigns signs_;
  Window window_;
  std::deque<Velocities> recent_;  ///< of the windows before
  /// Starts and stops that the accelerometer sees in the direction of the legs, or opposite.
  int along_ = 0, against_ = 0;
  std::array<SignalAgreement, 2> turns_;  ///< of feet, along x and y, and gyro
  std::array<SignalAgreement, 2>
      changes_;                            ///< of velocity by legs and accelerometer, along x and y
  std::array<Stance, kLegCount> stances_;  ///< while the robot walks
  int walked_ = 0;                         ///< windows with joints
  std::array<int, kJointCount> frozen_{};  ///< of them, in which the angle of a joint stood still
  std::array<SignalAgreement, kLegCount> slopes_;  ///< of the velocity by a foot, along z over x
};

}  // namespace aims
