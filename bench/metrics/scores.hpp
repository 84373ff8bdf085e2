// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/metrics/absolute_error.hpp"
#include "bench/metrics/alignment.hpp"
#include "bench/metrics/association.hpp"
#include "bench/metrics/drift.hpp"
#include "bench/metrics/path_error.hpp"
#include "bench/metrics/relative_error.hpp"
#include "bench/metrics/segments.hpp"
#include "bench/metrics/success.hpp"
#include "core/config.hpp"
#include "core/trajectory.hpp"

namespace aims {

/// Scores over surveyed points by the rules of the Hilti SLAM Challenges.
struct ControlPointScore {
  int points = 0;           ///< of the truth
  int reached = 0;          ///< of these, with an estimate at their time
  double score = 0.0;       ///< of 2022, 0 to 100
  double score_2023 = 0.0;  ///< of 2023, 0 to 100
};

/// Sum of what each position error [m] of aligned pairs earns: 10 below 1 cm, 6 below 3 cm, 3 below
/// 6 cm, 1 below 10 cm; of 10 for each of `points` [%]. Source: batch_evaluation.py of the
/// challenge of 2022. 0 without points.
double control_point_score(std::span<const double> errors, int points);

/// The same with 20 below 5 mm, 10 below 1 cm, 6 below 3 cm, 5 below 6 cm, 3 below 10 cm, 1 below
/// 40 cm, of 20 for each. Source: batch_evaluation.py of the challenge of 2023, single session.
double control_point_score_2023(std::span<const double> errors, int points);

/// What of the truth is measured.
enum class TruthContent {
  kAuto,      ///< as its file says; a pose where nothing says otherwise
  kPose,      ///< position and attitude
  kPosition,  ///< position alone, as of a total station: scores of attitude are absent
};

/// Parameters of the scores.
struct ScoreConfig {
  TruthContent truth = TruthContent::kAuto;
  double max_truth_gap = 2.0;  ///< [s]
  Association association = Association::kInterpolated;
  double association_tolerance = 0.01;                  ///< [s]
  AlignmentKind anchor = AlignmentKind::kStartHeading;  ///< or kStartPose
  double edge_tolerance = 3.0;                          ///< [s]
  double max_gap = 2.0;                                 ///< [s]
  double min_coverage = 0.5;                            ///< [-]
  double min_segment_length = 1.0;                      ///< [m]
  std::vector<std::string> segments;  ///< "a-d"; empty: from each named point to the next
  bool rpe_all_pairs = false;
  bool rpe_pairs_from_truth = true;
  bool sim3 = false;                                 ///< also align with a scale
  double max_error_offset = 0.5;                     ///< [m]
  double max_error_per_path = kSuccessErrorPerPath;  ///< [-]
};

void describe(Fields& fields, ScoreConfig& config);

/// All scores of one estimate. An undefined quantity has no value; none is ever NaN.
struct Scores {
  bool judged = true;              ///< false: the truth says nothing of the way, hence no success
  bool success = false;            ///< within 5 % of the distance
  bool success_1_percent = false;  ///< within 1 %
  FailureReason failure_reason = FailureReason::kNoOverlap;
  std::optional<Time> diverged_at;  ///< none on success, or when the reason is not the estimate's
  bool partial = false;             ///< poses are missing or invalid, whatever failed first

  int poses = 0;           ///< given by the estimator
  int poses_invalid = 0;   ///< not finite, not a rigid transform, or out of order
  int poses_compared = 0;  ///< associated with a true pose
  double coverage = 0.0;   ///< fraction of the truth's time with estimates

  std::vector<SegmentDistance> segments;  ///< M_list of each, in order
  std::optional<double> m_list_percent;   ///< over all segments
  std::optional<EndError> m_end;          ///< none when the estimate does not reach the end
  std::optional<double> start_to_end_m;   ///< distance of the estimate's last pose to its first
  std::optional<ControlPointScore> control_points;  ///< of Association::kAtTruth

  std::optional<double> ate_yaw_m;           ///< after the best heading and translation: headline
  std::optional<double> heading_error_rad;   ///< rms, after the same alignment
  std::optional<double> heading_offset_rad;  ///< of that alignment from the one at the start
  std::optional<AbsoluteErrorStatistics> ape_yaw;  ///< after the same alignment
  std::optional<double> ate_m;                     ///< aligned at the start
  std::optional<double> ate_se3_m;                 ///< after the best SE(3) alignment
  std::optional<double> ate_sim3_m;                ///< with a scale; on request
  std::optional<double> sim3_scale;                ///< of the estimate's positions; on request [-]
  PositionSpread se3_spread = PositionSpread::kPoint;  ///< less than kFull: evo gives no number
  std::optional<double> max_error_m;                   ///< aligned at the start
  std::optional<double> max_abs_z_error_m;             ///< aligned at the start

  std::vector<RpeScore> rpe;          ///< over 1 m and over 10 m
  PathErrors path_errors;             ///< over 5 m to 100 m
  std::optional<DriftSummary> drift;  ///< aligned at the start
};

/// Scores of an estimate (any fixed frame) against the truth. `waypoint_times` are in order of
/// time. Poor data (empty, not finite, one pose, no overlap) gives no success and undefined
/// quantities, never an error.
Scores score(const Trajectory& estimate, const Trajectory& truth,
             std::span<const WaypointTime> waypoint_times, const ScoreConfig& config);

/// The pairs of poses that are compared: without those in gaps of the truth.
std::vector<PosePair> compared_pairs(const Trajectory& estimate, const Trajectory& truth,
                                     const ScoreConfig& config);

/// The alignment at the start: `config.anchor`, or what it can be without the truth's attitude.
AlignmentKind start_alignment(const ScoreConfig& config);

/// Estimated and true poses after the alignment of the headline: by heading and translation.
std::vector<PosePair> headline_pairs(const Trajectory& estimate, const Trajectory& truth,
                                     const ScoreConfig& config);

/// Takes the success of an estimate for a reason that is not its own; one that it has itself stays,
/// unless it is one of what was cut off: that the estimate ends early, or hardly begins.
void withdraw_success(Scores& scores, FailureReason reason);

/// What a truth of the start and the end alone tells: the error of the end, and how much of the
/// time has poses. Everything else is of the way between them.
Scores end_scores(const Scores& scores);

/// As `score`, with an M_list of each of the segments, in order of time, and of no others.
Scores score_over(const Trajectory& estimate, const Trajectory& truth,
                  std::span<const Segment> segments, const ScoreConfig& config);

}  // namespace aims
