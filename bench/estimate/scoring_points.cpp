// SPDX-License-Identifier: BSD-3-Clause
#include "bench/estimate/scoring_points.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "bench/metrics/lever_arm.hpp"
#include "core/files/number_lines.hpp"
#include "core/text.hpp"
#include "recordings/trajectories/trajectory_file.hpp"

namespace aims {
namespace {

/// The numbers of a text of nothing else; empty otherwise.
std::vector<double> numbers_of(const std::string& text) {
  std::vector<double> numbers;
  for (const std::string_view word : words_of(text)) {
    const auto number = parse_number(word);
    if (!number) return {};
    numbers.push_back(*number);
  }
  return numbers;
}

/// Of "x y z qx qy qz qw", or of "x y z" where `may_be_position`.
Result<Pose> pose_of(std::string_view option, const std::string& text, bool may_be_position) {
  const std::vector<double> v = numbers_of(text);
  if (may_be_position && v.size() == 3) return Pose{{1.0, 0.0, 0.0, 0.0}, {v[0], v[1], v[2]}};
  const bool seven = v.size() == 7;
  const Eigen::Quaterniond rotation =
      seven ? Eigen::Quaterniond(v[6], v[3], v[4], v[5]) : Eigen::Quaterniond(0.0, 0.0, 0.0, 0.0);
  if (!(std::abs(rotation.norm() - 1.0) < 1e-3)) {
    return failure(
        fmt::format("{} '{}': expected 'x y z qx qy qz qw' in metres with a "
                    "unit quaternion{}",
                    option, text, may_be_position ? ", or 'x y z'" : ""));
  }
  return Pose{rotation.normalized(), {v[0], v[1], v[2]}};
}

/// The frame in which points of the body are given.
Result<Pose> lever_frame_of(const ScoringRequest& request) {
  if (request.lever_frame.empty()) return Pose();
  return pose_of("lever_frame", request.lever_frame, false);
}

Result<void> check_lever_arm(const ScoringRequest& request) {
  if (request.lever_arm.empty() || request.lever_arm == "estimate") return {};
  if (numbers_of(request.lever_arm).size() == 3) return {};
  return failure(
      fmt::format("--lever-arm '{}': expected 'x y z' in metres, or estimate", request.lever_arm));
}

/// Moves the estimates to the point that the truth measures.
Result<void> apply_lever_arm(const ScoringRequest& request, ScoringInput& input) {
  if (request.lever_arm.empty()) return {};
  if (auto right = check_lever_arm(request); !right) return right;
  const bool fitted = request.lever_arm == "estimate";
  const std::vector<double> v = numbers_of(request.lever_arm);
  const auto frame = lever_frame_of(request);
  if (!frame) return tl::unexpected(frame.error());
  const bool level = input.scoring.anchor == AlignmentKind::kStartHeading;
  for (SourcedTrajectory& each : input.estimates) {
    LeverArm lever;
    if (fitted) {
      const ValidPart part(each.trajectory);
      const Trajectory& valid = part.poses();
      lever = fit_lever_arm(compared_pairs(valid, input.truth.trajectory, input.scoring), level);
      const Eigen::Vector3d& p = lever.p_body_point;
      input.notes.push_back(fmt::format(
          "{}: lever arm fitted: [{}, {}, {}] m, {} of 3 directions observed; what it fits is no "
          "error any more",
          each.name, decimal_text(p.x(), 3), decimal_text(p.y(), 3), decimal_text(p.z(), 3),
          lever.observed));
    } else {
      lever.p_body_point = *frame * Eigen::Vector3d(v[0], v[1], v[2]);
    }
    each.trajectory = moved_to_point(std::move(each.trajectory), lever.p_body_point);
  }
  return {};
}

/// Moves the estimates to the points that were measured, each at its stamp.
Result<void> apply_lever_arms(const ScoringRequest& request, ScoringInput& input) {
  if (request.lever_arms.empty()) return {};
  auto points = read_trajectory(request.lever_arms, {PoseRules::kStrict, "", {}});
  if (!points) return tl::unexpected(points.error());
  if (points->trajectory.empty()) {
    return failure(request.lever_arms + ": expected the positions of control points, found none");
  }
  const auto frame = lever_frame_of(request);
  if (!frame) return tl::unexpected(frame.error());
  for (StampedPose& each : points->trajectory) {
    each.pose.translation = *frame * each.pose.translation;
  }
  for (SourcedTrajectory& each : input.estimates) {
    each.trajectory = moved_to_points(valid_part(each.trajectory), points->trajectory);
  }
  return {};
}

}  // namespace

Result<Pose> extrinsic_of(const std::string& text) {
  if (text.empty()) return Pose();
  constexpr double kMaxLever = 100.0;  // of a frame on a robot [m]
  auto pose = pose_of("--extrinsic", text, false);
  if (pose && pose->translation.norm() > kMaxLever) {
    return failure(fmt::format("--extrinsic '{}': expected at most {} m", text, kMaxLever));
  }
  return pose;
}

Result<void> check_points(const ScoringRequest& request) {
  if (auto pose = extrinsic_of(request.extrinsic); !pose) return tl::unexpected(pose.error());
  if (auto pose = lever_frame_of(request); !pose) return tl::unexpected(pose.error());
  if (!request.end_pose.empty()) {
    const auto pose = pose_of("--end-pose", request.end_pose, true);
    if (!pose) return tl::unexpected(pose.error());
  }
  return check_lever_arm(request);
}

Result<void> set_markers(const ScoringRequest& request, ScoringInput& input) {
  const auto end_pose = pose_of("--end-pose", request.end_pose, true);
  if (!end_pose) return tl::unexpected(end_pose.error());
  std::optional<Time> begin, end;
  for (const SourcedTrajectory& each : input.estimates) {
    const ValidPart part(each.trajectory);
    const Trajectory& valid = part.poses();
    if (valid.size() < 2) continue;
    begin = std::max(valid.front().stamp, begin.value_or(valid.front().stamp));
    end = std::min(valid.back().stamp, end.value_or(valid.back().stamp));
  }
  if (!begin || *begin >= *end) {
    return failure("--end-pose: expected estimates of two poses or more over the same time");
  }
  input.truth = {"markers",
                 "--end-pose",
                 "pose of the end in the frame of the start",
                 {{*begin, Pose()}, {*end, *end_pose}}};
  input.truth.has_attitude = numbers_of(request.end_pose).size() == 7;
  input.scoring.association = Association::kAtTruth;
  input.scoring.anchor = AlignmentKind::kStartPose;
  input.is_end_alone = true;
  return {};
}

Result<void> move_to_points(const ScoringRequest& request, ScoringInput& input) {
  auto done = apply_lever_arm(request, input);
  if (done) done = apply_lever_arms(request, input);
  return done;
}

}  // namespace aims
