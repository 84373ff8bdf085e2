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
/// "rear_left_foot". Nothing for other names.
std::optional<int> leg_of_name(std::string_view name);

/// A name that tells one leg, by a word for it or by a number behind "leg", "foot" or "limb".
struct NamedLeg {
  std::string id;          ///< "FL", or the number
  std::optional<int> leg;  ///< nothing for a number, which tells no place
  std::string rest;        ///< the name without it: "/contact/state" of "/contact/fl_foot/state"
};
std::optional<NamedLeg> named_leg(std::string_view name);

/// The joint within its leg: 0 abduction, 1 hip, 2 knee.
std::optional<int> joint_of_name(std::string_view name, bool abad = false);

/// Index of each of the twelve joints in a message's arrays.
using JointOrder = std::array<std::size_t, kJointCount>;

/// Whether twelve names tell the legs, three joints each, and none of them which joint it is.
bool names_tell_legs_alone(std::span<const std::string_view> recorded);

/// By the configured names if any, else by the recorded names. Where none are recorded, the
/// configured ones are indices. Where names tell the legs alone, their joints are taken as
/// abduction, hip and knee. Nothing when a joint is not found.
std::optional<JointOrder> joint_order(std::span<const std::string_view> recorded,
                                      std::span<const std::string> configured, std::size_t size);

/// Whether none of exactly twelve recorded names, or no name at all, tells a joint.
bool joints_are_unnamed(std::span<const std::string_view> recorded, std::size_t size);

/// As `foot_order`, but nothing where the names do not tell.
std::optional<std::vector<int>> named_foot_order(std::span<const std::string_view> recorded,
                                                 std::span<const std::string> configured,
                                                 std::size_t size);

/// The leg of each entry of an array of that size: by the configured names, else by the recorded
/// ones, else FL, FR, RL, RR. -1: no leg. Nothing when a leg has no entry.
std::optional<std::vector<int>> foot_order(std::span<const std::string_view> recorded,
                                           std::span<const std::string> configured,
                                           std::size_t size);

}  // namespace aims
