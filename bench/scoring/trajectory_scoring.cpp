// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scoring/trajectory_scoring.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "bench/scoring/motion_offset.hpp"
#include "bench/scoring/score_hints.hpp"
#include "bench/scoring/start_anchor.hpp"
#include "core/files/pose_cleaning.hpp"

namespace aims {
namespace {

/// Beyond this, as in map grids, positions are taken from the first one: scoring moves estimates
/// onto the truth anyway.
constexpr double kFar = 1e5;  ///< [m]

/// Between true poses farther apart than this, the straight line becomes a note.
constexpr Duration kLongTruthGap = kSecond;

std::string span_text(const Trajectory& trajectory) {
  return fmt::format("{:.3f} to {:.3f} s", to_seconds(trajectory.front().stamp),
                     to_seconds(trajectory.back().stamp));
}

Result<void> check_overlap(const SourcedTrajectory& estimate, const SourcedTrajectory& truth) {
  if (estimate.trajectory.empty()) {
    return failure(fmt::format("{}: expected poses, found none", estimate.source));
  }
  const auto by_stamp = [](const StampedPose& a, const StampedPose& b) {
    return a.stamp < b.stamp;
  };
  const auto [first, last] =
      std::minmax_element(estimate.trajectory.begin(), estimate.trajectory.end(), by_stamp);
  const Trajectory span = {*first, *last};
  const Time begin = truth.trajectory.front().stamp;
  if (first->stamp <= truth.trajectory.back().stamp && last->stamp >= begin) return {};
  for (const auto& hint : {frame_index_hint(estimate.trajectory, truth.trajectory),
                           stamp_unit_hint(estimate.trajectory, truth.trajectory)}) {
    if (hint) return failure(fmt::format("{}: {}", estimate.source, *hint));
  }
  const std::string apart =
      fmt::format("{}: its stamps, {}, do not overlap the truth's, {}: likely a clock offset; ",
                  estimate.source, span_text(span), span_text(truth.trajectory));
  if (const auto offset = motion_offset(estimate.trajectory, truth.trajectory)) {
    return failure(
        fmt::format("{}if both are of one walk, with --time-offset {:.2f} they stand and walk at "
                    "the same times (their speeds correlate by {:.2f})",
                    apart, offset->seconds, offset->correlation));
  }
  return failure(
      fmt::format("{}if both began together, --time-offset {:.9f} makes it good, if both ended "
                  "together, {:.9f} "
                  "(an estimator whose first pose is late did not begin with the truth)",
                  apart, to_seconds(begin - first->stamp),
                  to_seconds(truth.trajectory.back().stamp - last->stamp)));
}

void move_near(SourcedTrajectory& each, std::vector<std::string>& notes) {
  if (each.trajectory.empty()) return;
  const Eigen::Vector3d origin = each.trajectory.front().pose.translation;
  if (!origin.allFinite() || origin.norm() < kFar) return;
  for (StampedPose& pose : each.trajectory) pose.pose.translation -= origin;
  notes.push_back(
      fmt::format("{}: starts {:.0f} km from its origin: positions are taken from the "
                  "first one",
                  each.name, origin.norm() / 1000.0));
}

void note_gaps(const Trajectory& truth, const ScoreConfig& scoring,
               std::vector<std::string>& notes) {
  if (scoring.association == Association::kAtTruth) return;
  Duration longest = 0;
  for (std::size_t i = 1; i < truth.size(); ++i) {
    longest = std::max(longest, truth[i].stamp - truth[i - 1].stamp);
  }
  const auto gaps = gaps_in(truth, from_seconds(scoring.max_truth_gap));
  if (!gaps.empty() && scoring.association == Association::kInterpolated) {
    const Time begin = truth.front().stamp, end = truth.back().stamp;
    const double unknown = to_seconds(time_in(gaps, begin, end));
    notes.push_back(fmt::format(
        "truth: {} gap{} of more than {:g} s (scoring.max_truth_gap), together {:.1f} of {:.1f} s: "
        "nothing is scored there",
        gaps.size(), gaps.size() == 1 ? "" : "s", scoring.max_truth_gap, unknown,
        to_seconds(end - begin)));
  } else if (longest > kLongTruthGap) {
    notes.push_back(
        fmt::format("truth: no pose for up to {:.1f} s; there it is taken as a straight "
                    "line",
                    to_seconds(longest)));
  }
}

void note_truth(const ScoringInput& input, std::vector<std::string>& notes) {
  const Trajectory& truth = input.truth.trajectory;
  note_gaps(truth, input.scoring, notes);
  if (input.segments.empty()) {
    notes.emplace_back("no reference points: no M_list");
    return;
  }
  for (const Segment& each : input.segments) {
    const auto begin = pose_at(truth, each.begin);
    const auto end = pose_at(truth, each.end);
    const double length = begin && end ? (end->translation - begin->translation).norm() : 0.0;
    if (length >= input.scoring.min_segment_length) continue;
    notes.push_back(
        begin && end
            ? fmt::format("segment {}: its ends are {:.2f} m apart, less than "
                          "scoring.min_segment_length: no M_list",
                          each.name, length)
            : fmt::format("segment {}: not within the truth's stamps: no M_list", each.name));
  }
}

/// What likely makes the scores what they are, with the option that corrects it.
void note_causes(const TrajectoryScores& result, std::vector<std::string>& notes) {
  const Trajectory& truth = result.truth.trajectory;
  std::vector<const Trajectory*> estimates;
  for (const ScoredEstimate& each : result.estimates) estimates.push_back(&each.given.trajectory);
  if (const auto hint = frozen_truth_hint(truth, estimates)) notes.push_back("truth: " + *hint);
  for (const ScoredEstimate& each : result.estimates) {
    const Trajectory& given = each.given.trajectory;
    for (const auto& hint :
         {frame_index_hint(given, truth), stamp_unit_hint(given, truth),
          clock_offset_hint(given, truth), position_unit_hint(given, truth, result.scoring),
          world_hint(given, truth, result.scoring),
          body_frame_hint(given, truth, each.given.T_body_estimate, result.scoring)}) {
      if (hint) notes.push_back(fmt::format("{}: {}", each.given.name, *hint));
    }
  }
}

void note_estimates(const TrajectoryScores& result, std::vector<std::string>& notes) {
  std::vector<std::string> straight;
  for (const ScoredEstimate& each : result.estimates) {
    const Scores& scores = each.scores;
    if (scores.ate_se3_m && scores.se3_spread != PositionSpread::kFull) {
      straight.push_back(each.given.name);
    }
    if (covers_too_little(each, result.scoring)) {
      notes.push_back(fmt::format(
          "{}: covers {:.1f} % of the truth's time with poses at most {:g} s apart, less than "
          "scoring.min_coverage, {:g} %: its scores are not of the whole route",
          each.given.name, 100.0 * scores.coverage, result.scoring.max_gap,
          100.0 * result.scoring.min_coverage));
    }
    if (scores.poses_invalid == 0) continue;
    notes.push_back(fmt::format("{}: {} of {} poses left out: {}", each.given.name,
                                scores.poses_invalid, scores.poses,
                                unusable_text(each.given.trajectory)));
  }
  if (straight.empty()) return;
  notes.push_back(
      fmt::format("{}: too straight (or too few poses) for evo's SE(3) alignment: Umeyama's "
                  "covariance lacks rank; ATE SE(3) takes the angles that the positions tell by "
                  "least squares, and the rotation about their line from the first pose",
                  fmt::join(straight, ", ")));
}

ScoredEstimate score_one(SourcedTrajectory estimate, const ScoringInput& input) {
  const Trajectory& truth = input.truth.trajectory;
  ScoredEstimate scored;
  scored.scores = score_over(estimate.trajectory, truth, input.segments, input.scoring);
  if (input.is_end_alone) scored.scores = end_scores(scored.scores);
  scored.in_truth_frame = anchored(estimate.trajectory, truth, input.scoring);
  if (const auto difference = median_stamp_difference(scored.in_truth_frame, truth)) {
    scored.median_stamp_difference_s = to_seconds(*difference);
  }
  scored.given = std::move(estimate);
  return scored;
}

}  // namespace

bool covers_too_little(const ScoredEstimate& estimate, const ScoreConfig& scoring) {
  return estimate.scores.coverage < scoring.min_coverage;
}

Result<void> check_compared(const TrajectoryScores& scores) {
  for (const ScoredEstimate& each : scores.estimates) {
    const Scores& of = each.scores;
    if (of.poses_compared >= 2) continue;
    return failure(fmt::format(
        "{}: expected at least two poses to compare with the truth, found {}: of {} poses, {} are "
        "valid (finite, with a unit quaternion and increasing stamps), {} of them within the "
        "truth's stamps",
        each.given.source, of.poses_compared, of.poses, of.poses - of.poses_invalid,
        of.poses_compared));
  }
  return {};
}

Result<TrajectoryScores> score_trajectories(ScoringInput input) {
  TrajectoryScores result;
  result.notes = std::move(input.notes);
  if (input.truth.trajectory.size() < 2) {
    return failure(fmt::format("{}: expected at least two true poses, found {}{}",
                               input.truth.source, input.truth.trajectory.size(),
                               input.truth.dropped.empty() ? "" : "; " + input.truth.dropped));
  }
  move_near(input.truth, result.notes);
  note_truth(input, result.notes);
  for (SourcedTrajectory& estimate : input.estimates) {
    if (auto overlap = check_overlap(estimate, input.truth); !overlap) {
      return tl::unexpected(overlap.error());
    }
    move_near(estimate, result.notes);
    result.estimates.push_back(score_one(std::move(estimate), input));
  }
  result.truth = std::move(input.truth);
  result.waypoint_times = std::move(input.waypoint_times);
  result.segments = std::move(input.segments);
  result.scoring = std::move(input.scoring);
  note_causes(result, result.notes);
  note_estimates(result, result.notes);
  return result;
}

}  // namespace aims
