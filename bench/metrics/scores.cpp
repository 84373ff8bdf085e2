// SPDX-License-Identifier: BSD-3-Clause
#include "bench/metrics/scores.hpp"

#include <algorithm>
#include <array>

namespace aims {
namespace {

struct Class {
  double below;  ///< position error [m]
  int earned;
};

constexpr std::array<Class, 4> kOf2022 = {{{0.01, 10}, {0.03, 6}, {0.06, 3}, {0.10, 1}}};
constexpr std::array<Class, 6> kOf2023 = {
    {{0.005, 20}, {0.01, 10}, {0.03, 6}, {0.06, 5}, {0.10, 3}, {0.40, 1}}};

/// Of what the first class earns for each point [%].
double score_by(std::span<const Class> classes, std::span<const double> errors, int points) {
  if (points <= 0) return 0.0;
  int sum = 0;
  for (const double error : errors) {
    const auto found =
        std::ranges::find_if(classes, [error](const Class& each) { return error < each.below; });
    if (found != classes.end()) sum += found->earned;
  }
  return 100.0 * sum / (classes.front().earned * points);
}

}  // namespace

double control_point_score(std::span<const double> errors, int points) {
  return score_by(kOf2022, errors, points);
}

double control_point_score_2023(std::span<const double> errors, int points) {
  return score_by(kOf2023, errors, points);
}

namespace {

constexpr double kRpeDeltas[] = {1.0, 10.0};  ///< [m]

void describe_truth(Fields& f, ScoreConfig& c) {
  f.choice("truth", c.truth,
           {{"auto", TruthContent::kAuto},
            {"pose", TruthContent::kPose},
            {"position", TruthContent::kPosition}},
           {.meaning = "What of the truth is measured; auto: as its format says."});
  f.number(
      "max_truth_gap", c.max_truth_gap,
      {.unit = "s",
       .range = positive_up_to(1e6),
       .meaning = "Longest time between true poses over which they are interpolated; in longer "
                  "gaps nothing is scored."});
}

void describe_association(Fields& f, ScoreConfig& c) {
  f.choice("association", c.association,
           {{"interpolated", Association::kInterpolated},
            {"nearest", Association::kNearest},
            {"at_truth", Association::kAtTruth}},
           {.meaning = "Association of estimated and true poses; nearest is the rule of evo, "
                       "at_truth interpolates the estimate at the stamps of control points.",
            .source = "evo, core/sync"});
  f.number("association_tolerance", c.association_tolerance,
           {.unit = "s",
            .range = up_to(1e6),
            .meaning = "Largest difference of stamps for the nearest association.",
            .source = "evo's default"});
  f.choice(
      "anchor", c.anchor,
      {{"pose", AlignmentKind::kStartPose}, {"heading", AlignmentKind::kStartHeading}},
      {.meaning = "Alignment at the start: position and heading of the first pose, or the whole "
                  "pose, the mean over the second half of the standing start."});
  f.number("edge_tolerance", c.edge_tolerance,
           {.unit = "s",
            .range = up_to(1e6),
            .meaning = "Longest time without an estimate at the start and at the end; covers the "
                       "standing start in which estimators initialize."});
  f.number(
      "max_gap", c.max_gap,
      {.unit = "s", .range = positive_up_to(1e6), .meaning = "Longest time without an estimate."});
  f.number("min_coverage", c.min_coverage,
           {.unit = "-",
            .range = in_range(0.0, 1.0),
            .meaning = "Least fraction of the truth's time with estimates; below half, most of the "
                       "route is unknown and no score is one of the route."});
}

void describe_metrics(Fields& f, ScoreConfig& c) {
  f.texts("segments", c.segments,
          {.meaning = "Segments for M_list, as [a-d, d-h]; empty: from each named point to the "
                      "next.",
           .source = "table II"});
  f.number(
      "min_segment_length", c.min_segment_length,
      {.unit = "m", .range = positive_up_to(1e4), .meaning = "Shortest segment with an M_list."});
  f.flag("rpe_all_pairs", c.rpe_all_pairs,
         {.meaning = "Relative pose error from every pose instead of consecutive pairs.",
          .source = "evo, core/filters"});
  f.flag("rpe_pairs_from_truth", c.rpe_pairs_from_truth,
         {.meaning = "Measure the path length of the relative pose error along the truth, the same "
                     "for every estimator; the default of evo is the estimate."});
  f.flag("sim3", c.sim3,
         {.meaning = "Also align with a scale, for systems that do not observe it: ate_sim3_m."});
  f.number("max_error_offset", c.max_error_offset,
           {.unit = "m",
            .range = up_to(1e4),
            .meaning = "Position error that no success is lost by, whatever the path: 5 % of 10 m; "
                       "of the limit of 1 % a fifth."});
  f.number("max_error_per_path", c.max_error_per_path,
           {.unit = "-",
            .range = up_to(1e6),
            .meaning = "Largest position error of a success per metre of path so far."});
}

/// M_end, unless the estimate stops before the truth does: then its end is another place.
std::optional<EndError> end_error_if_reached(std::span<const PosePair> anchored,
                                             const Trajectory& truth, Duration edge) {
  if (anchored.size() < 2 || truth.back().stamp - anchored.back().stamp > edge) return std::nullopt;
  return end_error(anchored);
}

bool has_attitude(const ScoreConfig& config) { return config.truth != TruthContent::kPosition; }

/// By heading and translation.
void score_headline(Scores& scores, std::span<const PosePair> level, const ScoreConfig& config) {
  if (level.size() < 2) return;
  const Alignment yaw = align_yaw(level);
  scores.ate_yaw_m = ate_rmse(level, yaw);
  scores.ape_yaw = absolute_error_statistics(level, yaw);
  if (has_attitude(config)) scores.heading_error_rad = heading_rmse(level, yaw);
}

/// Whether frames are level as they are; others are levelled at the start.
bool is_level(const ScoreConfig& config) { return config.anchor == AlignmentKind::kStartHeading; }

/// What needs the pairs as they are. After alignment a single pose always equals its truth.
void score_pairs(Scores& scores, std::span<const PosePair> pairs, const ScoreConfig& config) {
  if (pairs.size() < 2) return;
  if (is_level(config)) score_headline(scores, pairs, config);
  const Alignment se3 = align_se3(pairs);
  scores.se3_spread = se3.spread;
  scores.ate_se3_m = ate_rmse(pairs, se3);
  if (scores.control_points) {
    ControlPointScore& points = *scores.control_points;
    const std::vector<double> errors = position_errors(pairs, se3);
    points.score = control_point_score(errors, points.points);
    points.score_2023 = control_point_score_2023(errors, points.points);
  }
  if (!config.sim3) return;
  const Alignment sim3 = align_sim3(pairs);
  scores.ate_sim3_m = ate_rmse(pairs, sim3);
  scores.sim3_scale = sim3.scale;
}

/// What needs them aligned at the start.
void score_anchored(Scores& scores, std::span<const PosePair> anchored, const ScoreConfig& config) {
  if (anchored.size() < 2) return;
  if (!is_level(config)) score_headline(scores, anchored, config);
  scores.max_error_m = max_error(anchored);
  scores.max_abs_z_error_m = max_abs_z_error(anchored);
  if (!has_attitude(config)) return;
  scores.heading_offset_rad = yaw_of(align_yaw(anchored).T_truth_estimate.rotation);
  scores.ate_m = ate_rmse(anchored);
}

SuccessLimits limits_of(const Trajectory& truth, const ScoreConfig& config) {
  SuccessLimits limits{.error_offset = config.max_error_offset,
                       .error_per_path = config.max_error_per_path,
                       .edge = from_seconds(config.edge_tolerance),
                       .gap = from_seconds(config.max_gap),
                       .coverage = config.min_coverage};
  limits.at_points = config.association == Association::kAtTruth;
  if (!limits.at_points) limits.truth_gaps = gaps_in(truth, from_seconds(config.max_truth_gap));
  return limits;
}

void score_success(Scores& scores, const Trajectory& estimate, const Trajectory& truth,
                   std::span<const PosePair> anchored, SuccessLimits limits) {
  const SuccessVerdict verdict = judge(estimate, truth, anchored, limits);
  scores.success = verdict.reason == FailureReason::kNone;
  scores.failure_reason = verdict.reason;
  scores.diverged_at = verdict.diverged_at;
  scores.partial = verdict.partial;
  limits.error_offset *= kStrictErrorPerPath / kSuccessErrorPerPath;
  limits.error_per_path = std::min(limits.error_per_path, kStrictErrorPerPath);
  scores.success_1_percent =
      judge(estimate, truth, anchored, limits).reason == FailureReason::kNone;
}

std::vector<RpeScore> relative_errors(std::span<const PosePair> pairs, const ScoreConfig& config) {
  std::vector<RpeScore> scores;
  for (const double delta : kRpeDeltas) {
    RpeOptions options;
    options.delta = delta;
    options.all_pairs = config.rpe_all_pairs;
    options.pairs_from_truth = config.rpe_pairs_from_truth;
    scores.push_back(relative_pose_error(pairs, options));
  }
  return scores;
}

/// Relative errors are taken in the axes of the true body, so that they need its attitude.
void score_relative(Scores& scores, std::span<const PosePair> pairs, const ScoreConfig& config) {
  const std::span<const PosePair> known = has_attitude(config) ? pairs : pairs.first(0);
  scores.rpe = relative_errors(known, config);
  scores.path_errors = path_errors(known);
}

}  // namespace

void describe(Fields& fields, ScoreConfig& config) {
  describe_truth(fields, config);
  describe_association(fields, config);
  describe_metrics(fields, config);
}

Scores score(const Trajectory& estimate, const Trajectory& truth,
             std::span<const WaypointTime> waypoint_times, const ScoreConfig& config) {
  return score_over(estimate, truth, segments_wanted(waypoint_times, config.segments), config);
}

std::vector<PosePair> compared_pairs(const Trajectory& estimate, const Trajectory& truth,
                                     const ScoreConfig& config) {
  const bool at_points = config.association == Association::kAtTruth;
  auto pairs = associate(estimate, truth, config.association,
                         from_seconds(at_points ? config.max_gap : config.association_tolerance));
  if (config.association != Association::kInterpolated) return pairs;
  return outside(gaps_in(truth, from_seconds(config.max_truth_gap)), std::move(pairs));
}

AlignmentKind start_alignment(const ScoreConfig& config) {
  if (has_attitude(config)) return config.anchor;
  return config.anchor == AlignmentKind::kStartPose ? AlignmentKind::kStartSe3
                                                    : AlignmentKind::kStartYaw;
}

std::vector<PosePair> headline_pairs(const Trajectory& estimate, const Trajectory& truth,
                                     const ScoreConfig& config) {
  const ValidPart valid(estimate), valid_truth(truth);
  std::vector<PosePair> pairs = compared_pairs(valid.poses(), valid_truth.poses(), config);
  if (!is_level(config)) {
    const Alignment start = align_start(pairs, start_alignment(config));
    pairs = aligned(std::move(pairs), start);
  }
  const Alignment yaw = align_yaw(pairs);
  return aligned(std::move(pairs), yaw);
}

void withdraw_success(Scores& scores, FailureReason reason) {
  scores.success = false;
  scores.success_1_percent = false;
  scores.partial = scores.partial || is_lack_of_poses(reason);
  const FailureReason own = scores.failure_reason;
  if (own == FailureReason::kInvalid || own == FailureReason::kGap ||
      own == FailureReason::kErrorLimit) {
    return;
  }
  scores.failure_reason = reason;
  scores.diverged_at.reset();
}

Scores end_scores(const Scores& scores) {
  Scores end;
  end.judged = false;
  end.failure_reason = FailureReason::kNone;
  end.partial = scores.partial;
  end.poses = scores.poses;
  end.poses_invalid = scores.poses_invalid;
  end.poses_compared = scores.poses_compared;
  end.coverage = scores.coverage;
  end.m_end = scores.m_end;
  end.start_to_end_m = scores.start_to_end_m;
  return end;
}

Scores score_over(const Trajectory& estimate, const Trajectory& truth,
                  std::span<const Segment> segments, const ScoreConfig& config) {
  const ValidPart valid_estimate(estimate), valid_true(truth);
  const Trajectory &valid = valid_estimate.poses(), &valid_truth = valid_true.poses();
  std::vector<PosePair> pairs = compared_pairs(valid, valid_truth, config);
  const Duration edge = from_seconds(config.edge_tolerance);
  const SuccessLimits limits = limits_of(valid_truth, config);

  Scores scores;
  scores.poses = static_cast<int>(estimate.size());
  scores.poses_invalid = static_cast<int>(estimate.size() - valid.size());
  scores.poses_compared = static_cast<int>(pairs.size());
  scores.coverage = coverage_of(pairs, valid_truth, limits);
  scores.segments = segment_distances(valid, valid_truth, segments, config.min_segment_length,
                                      {.edge = edge, .gap = from_seconds(config.max_gap)});
  scores.m_list_percent = m_list_percent(scores.segments);
  if (valid.size() >= 2) {
    scores.start_to_end_m = (valid.back().pose.translation - valid.front().pose.translation).norm();
  }
  if (limits.at_points) {
    scores.control_points = {static_cast<int>(valid_truth.size()), static_cast<int>(pairs.size())};
  }
  score_pairs(scores, pairs, config);
  score_relative(scores, pairs, config);

  const Alignment start = align_start(pairs, start_alignment(config));
  const std::vector<PosePair> anchored = aligned(std::move(pairs), start);  // one copy at a time
  score_success(scores, estimate, valid_truth, anchored, limits);
  scores.m_end = end_error_if_reached(anchored, valid_truth, edge);
  score_anchored(scores, anchored, config);
  if (anchored.size() >= 2) scores.drift = drift_summary(anchored, valid_truth, segments);
  if (scores.drift) scores.drift->has_attitude = has_attitude(config);
  return scores;
}

}  // namespace aims
