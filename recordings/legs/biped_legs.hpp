// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "core/measurements.hpp"
#include "recordings/legs/leg_messages.hpp"
#include "recordings/messages/robot_states.hpp"

namespace aims {

/// The soles of a biped from the angles [rad] and rates [rad/s] of its joints, each as both legs of
/// its side. Nothing for too few joints.
std::optional<FeetReading> biped_feet(const BipedLegs& legs, Time stamp,
                                      const std::vector<double>& angles,
                                      const std::vector<double>& rates);

/// The torques of its knees, each as the load of both legs of its side [N m].
std::optional<FootLoads> knee_torques(const std::vector<double>& torques, const BipedLegs& legs);

}  // namespace aims
