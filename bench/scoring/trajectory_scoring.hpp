// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/metrics/scores.hpp"
#include "bench/metrics/segments.hpp"
#include "core/error.hpp"
#include "core/trajectory.hpp"

namespace aims {

/// A trajectory and where it is from.
struct SourcedTrajectory {
  std::string name;    ///< in tables and pictures
  std::string source;  ///< as given: a file, or a bag and its topic
  std::string kind;    ///< "TUM", "KITTI poses", "nav_msgs/Odometry on /odom"
  Trajectory trajectory;
  std::string body_frame = {};  ///< whose poses they are, where the file states it; e.g. "lidar"
  bool has_attitude = true;     ///< false: positions alone
  Pose T_body_estimate = {};    ///< taken off its poses (--extrinsic)
  std::string dropped = {};     ///< which poses its reader left out: "2 of 5 poses dropped: ..."
};

/// Trajectories of any system, the truth, and over which ways M_list is taken.
struct ScoringInput {
  SourcedTrajectory truth;                   ///< valid poses with increasing stamps
  std::vector<SourcedTrajectory> estimates;  ///< of the same body, as their systems gave them
  std::vector<WaypointTime> waypoint_times;
  std::vector<Segment> segments;  ///< in order of time; none: there is no M_list
  ScoreConfig scoring;
  bool is_end_alone = false;       ///< the truth is the pose of the end, from the start
  std::vector<std::string> notes;  ///< what was assumed while reading, a sentence each
};

/// An estimate with its scores and how it met the truth.
struct ScoredEstimate {
  SourcedTrajectory given;
  Trajectory in_truth_frame;  ///< its valid poses laid onto the truth at the start
  Scores scores;
  std::optional<double> median_stamp_difference_s;  ///< to the nearest true pose
};

/// What `score_trajectories` yields.
struct TrajectoryScores {
  SourcedTrajectory truth;
  std::vector<WaypointTime> waypoint_times;
  std::vector<Segment> segments;
  ScoreConfig scoring;
  std::vector<ScoredEstimate> estimates;
  std::vector<std::string> notes;  ///< what a reader of the numbers must know, a sentence each
};

/// Whether the estimate covers less of the truth than `scoring.min_coverage`: its scores are not of
/// the route.
bool covers_too_little(const ScoredEstimate& estimate, const ScoreConfig& scoring);

/// Error for the first estimate with fewer than two poses that can be compared: it has no scores.
Result<void> check_compared(const TrajectoryScores& scores);

/// Scores each estimate against the truth. Error when the truth has fewer than two poses, or when
/// the stamps of an estimate do not overlap the truth's: a clock offset, which no score shows.
Result<TrajectoryScores> score_trajectories(ScoringInput input);

}  // namespace aims
