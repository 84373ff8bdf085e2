// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include "core/measurements.hpp"

namespace aims::leg_kilo {

/// A foot that stands on the ground, as the joints see it.
struct StandingFoot {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< from the base, body axes [m]
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< J dq/dt, body axes [m/s]
};

/// Whether the sample has joint angles and the rig the lengths of the legs.
bool has_joints(const LegOdometrySample& sample, const SensorRig& rig);

/// Contacts from forces, with a threshold to begin and a lower one to end. At first all feet are in
/// contact, as in the published program.
class ContactHysteresis {
 public:
  /// Forces that begin and end a contact [N].
  ContactHysteresis(double begin, double end) : begin_(begin), end_(end) {}

  /// The contacts after the next sample: by its forces, else as it reports them.
  const std::array<bool, kLegCount>& update(const LegOdometrySample& sample);

 private:
  double begin_;
  double end_;
  std::array<bool, kLegCount> contact_ = {true, true, true, true};
};

/// The feet in contact, by their joints.
std::vector<StandingFoot> feet_in_contact(const LegOdometrySample& sample, const SensorRig& rig);

/// Four feet under the hips, all standing: the joints that would report the sample's twist.
std::vector<StandingFoot> feet_of_twist(const LegOdometrySample& sample, const SensorRig& rig);

}  // namespace aims::leg_kilo
