// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "core/trajectory.hpp"

namespace aims {

/// What has to be added to the stamps of an estimate for it to move when the truth does.
struct MotionOffset {
  double seconds = 0.0;
  double correlation = 0.0;  ///< of the speeds there, at most 1
};

/// The offset at which the speeds of both, over a second each, correlate best, whatever their
/// clocks. Nothing where they have fewer than 5 s in common there, correlate by less than 0.9, or
/// nearly as well at an offset of more than 2 s from it: a robot that walks without a stop tells
/// nothing.
std::optional<MotionOffset> motion_offset(const Trajectory& estimate, const Trajectory& truth);

/// Where an offset of 0.2 s or more halves what the speeds lack to a correlation of 1: that offset
/// and the option that takes it away.
std::optional<std::string> clock_offset_hint(const Trajectory& estimate, const Trajectory& truth);

}  // namespace aims
