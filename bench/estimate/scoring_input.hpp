// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "bench/scoring/trajectory_scoring.hpp"
#include "core/error.hpp"

namespace aims {

/// Where the trajectories to be scored come from, as given on the command line.
struct ScoringRequest {
  std::string truth;                            ///< a file, or "run.bag:/topic"
  std::vector<std::string> estimates;           ///< likewise
  std::map<std::string, Trajectory> in_memory;  ///< those that are no files, by the text given
  std::vector<std::string> names;  ///< of the estimates; none: by their files and topics
  std::filesystem::path times;     ///< stamps of KITTI poses; empty: none
  std::filesystem::path
      waypoint_times;     ///< waypoint_times.csv; empty: the bag's own, if the truth is one
  std::string segments;   ///< see `parse_segments`; empty: as the configuration says
  std::string extrinsic;  ///< "x y z qx qy qz qw", T_body_estimate: pose of the estimates' frame
  /// "x y z": the point that the truth measures, e.g. a prism, in the frame of the estimates [m];
  /// "estimate": the one that fits best; empty: the frame itself.
  std::string lever_arm;
  /// File of positions by stamp: where the points that the truth measures were in a frame of the
  /// body, at the stamps of the truth, e.g. control points in the LiDAR's; empty: none.
  std::string lever_arms;
  /// "x y z qx qy qz qw": pose of the frame in which `lever_arm` or `lever_arms` is; empty: the
  /// estimates'.
  std::string lever_frame;
  /// In place of a truth: the pose of the end in the frame of the start, "x y z qx qy qz qw", or
  /// "x y z", of which only the distance counts. Empty: there is a truth.
  std::string end_pose;
  double time_offset_s = 0.0;    ///< added to the stamps of the estimates
  std::string stamp_unit = "s";  ///< of estimates in text files: s, ms, us or ns
  ScoreConfig scoring;
  /// `scoring` is of a configuration, whose segments count before those that a run states.
  bool is_configured = false;
};

/// Decides what the truth measures, where the configuration leaves it open: positions alone where
/// it has no attitude, or one that never changes while an estimate turns; notes it.
void resolve_truth_content(ScoringInput& input);

/// Reads all that is needed to score. Errors are one line that names the file or the option.
Result<ScoringInput> read_scoring_input(const ScoringRequest& request);

}  // namespace aims
