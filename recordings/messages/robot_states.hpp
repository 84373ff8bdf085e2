// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string_view>

#include "core/leg_geometry.hpp"
#include "core/measurements.hpp"

namespace aims {

/// What the numbers of the contacts are.
enum class ContactKind {
  kCounts,  ///< of a force sensor without calibration
  kState,   ///< a number that says whether the foot stands
  kTorque,  ///< of the knee [N m]
};

/// A joint of a leg below the one before it, or below the trunk.
struct ChainJoint {
  std::array<double, 3> offset;  ///< from the joint before [m]; left leg, y is mirrored for right
  double pitch;                  ///< fixed turn about y before the joint's own [rad]
  int axis;                      ///< of the joint: 0 x, 1 y, 2 z
};

/// The legs of a biped: the joints of the left leg come first, those of the right one follow.
struct BipedLegs {
  std::array<ChainJoint, 6> joints;
  double sole;       ///< below the last joint [m]
  std::size_t knee;  ///< number of the knee in its leg
};

/// How a message type of a robot holds its IMU and legs. A robot is a row of data. Paths: "a.b" is
/// a field, "a[].b" the field b of each entry of a. Empty: the type lacks it.
struct StateLayout {
  std::string_view type = {};
  std::string_view robot = {};  ///< whose geometry this is, in words
  std::string_view topic = {};  ///< its usual name
  std::string_view imu = {};    ///< quaternion (w first), gyroscope, accelerometer below it
  std::string_view angles = {}, rates = {};      ///< of the joints [rad], [rad/s]
  std::string_view joint_names = {};             ///< without: leg by leg, abduction, hip, knee
  std::string_view feet = {}, foot_speeds = {};  ///< in the base [m], [m/s]; no speeds: differences
  std::string_view contacts = {};    ///< one number per foot, or per joint where those are named
  std::string_view foot_names = {};  ///< of the numbers; without: in the order of `legs`
  ContactKind contact_kind = ContactKind::kCounts;
  std::array<int, kLegCount> legs = {0, 1, 2, 3};  ///< of the entries that have no names
  double knee_offset = 0.0;  ///< of the straight front knee; behind its negative [rad]
  const LegGeometry* geometry = nullptr;
  const BipedLegs* biped = nullptr;

  bool has_joints() const { return !angles.empty() && biped == nullptr; }
  bool has_feet() const { return !feet.empty() || biped != nullptr; }
};

/// All rows; those of the same type that hold more come first.
std::span<const StateLayout> robot_states();

/// The first row of that type whose fields occur in the definition; null: none.
const StateLayout* robot_state_of(std::string_view type, std::string_view definition);

/// Whether a row of that type has an IMU.
bool is_robot_state_with_imu(std::string_view type);

/// The prefixes of the IMUs of all rows, each once.
std::span<const std::string_view> robot_imus();

}  // namespace aims
