// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <string>

#include "bench/metrics/scores.hpp"
#include "core/trajectory.hpp"

namespace aims {

/// Where the estimate's stamps span about 1e3, 1e6 or 1e9 times the truth's: their likely unit and
/// the option that reads it, "its stamps span 1000 times the truth's: likely ms, which --stamp-unit
/// ms reads"; of the opposite, that the truth's stamps are such.
std::optional<std::string> stamp_unit_hint(const Trajectory& estimate, const Trajectory& truth);

/// Whether the stamps are numbers of frames: whole ones that rise from 0 or 1 on.
bool is_frame_index(const Trajectory& poses);

/// Where the stamps of one side alone are numbers of frames, and do not fit the other's: that, and
/// what to do.
std::optional<std::string> frame_index_hint(const Trajectory& estimate, const Trajectory& truth);

/// Where the truth repeats one pose over its last two seconds or more, and every estimate moves on:
/// since when.
std::optional<std::string> frozen_truth_hint(const Trajectory& truth,
                                             std::span<const Trajectory* const> estimates);

/// Where the positions of one side spread 1000 or 100 times as far as the other's: their likely
/// unit.
std::optional<std::string> position_unit_hint(const Trajectory& estimate, const Trajectory& truth,
                                              const ScoreConfig& config);

/// Where positions fit ten times better, and well, with the axes of the truth's world turned (NED,
/// of a camera) or mirrored, or with the truth as the inverse pose: that convention.
std::optional<std::string> world_hint(const Trajectory& estimate, const Trajectory& truth,
                                      const ScoreConfig& config);

/// Where the positions fit and the attitude differs from the truth's by one constant rotation of
/// the body frame, of more than 10 deg: that rotation and the --extrinsic that takes it away, where
/// `T_body_estimate` was already applied.
std::optional<std::string> body_frame_hint(const Trajectory& estimate, const Trajectory& truth,
                                           const Pose& T_body_estimate, const ScoreConfig& config);

}  // namespace aims
