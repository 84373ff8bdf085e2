// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "bench/estimate/scoring_input.hpp"

namespace aims {

/// Of the text of `--extrinsic`; the identity without one.
Result<Pose> extrinsic_of(const std::string& text);

/// Error for an extrinsic, a lever arm, its frame or a pose of the end that is not written as one.
Result<void> check_points(const ScoringRequest& request);

/// Sets a truth of the start and the end of all estimates alone.
Result<void> set_markers(const ScoringRequest& request, ScoringInput& input);

/// Moves the estimates to the point that the truth measures, or to the points, each at its stamp.
Result<void> move_to_points(const ScoringRequest& request, ScoringInput& input);

}  // namespace aims
