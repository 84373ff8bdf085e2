// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "core/trajectory.hpp"

namespace aims {

/// Whether all quaternions are zero, as where positions are written as poses: they become the
/// identity, which is noted.
bool is_of_positions(Trajectory& poses, const std::string& name, std::vector<std::string>& notes);

/// Normalizes quaternions that are off unit norm as rounded decimals are, and notes it.
void normalize_rounded(Trajectory& poses, const std::string& name, std::vector<std::string>& notes);

/// Removes poses that are not finite, no rotations, stamped not after the one before, or of a body
/// that a motion capture had lost (or not found yet); notes and yields how many of each.
std::string drop_unusable(Trajectory& poses, const std::string& name,
                          std::vector<std::string>& notes);

/// "the positions jump ..." where a truth moves as no robot does, as after a motion capture froze;
/// else empty.
std::string leaps_text(const Trajectory& truth);

/// "2 not finite, 1 stamped not after the one before"; empty where all poses are usable.
std::string unusable_text(const Trajectory& poses);

}  // namespace aims
