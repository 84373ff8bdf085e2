// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/measurements.hpp"

namespace aims {

/// The leg that a joint or foot of that name belongs to: "FL_hip_joint", "LF_HAA", "fl.hx",
/// "rear_left_foot". Nothing when the name tells none.
std::optional<int> leg_of_name(std::string_view name);

/// The joint of a leg that such a name tells: 0 abduction, 1 hip, 2 knee.
std::optional<int> joint_of_name(std::string_view name);

/// Where each of the twelve joints stands in a message's arrays.
using JointOrder = std::array<std::size_t, kJointCount>;

/// By the configured names if there are any, else by what the recorded names tell, else as recorded
/// if there are just twelve. Nothing when some joint is not found.
std::optional<JointOrder> joint_order(std::span<const std::string_view> recorded,
                                      std::span<const std::string> configured, std::size_t size);

/// The leg of each entry of an array of that size: by the configured names, else by the recorded
/// ones, else FL, FR, RL, RR. -1: of no leg. Nothing when some leg has no entry.
std::optional<std::vector<int>> foot_order(std::span<const std::string_view> recorded,
                                           std::span<const std::string> configured,
                                           std::size_t size);

}  // namespace aims
