// SPDX-License-Identifier: BSD-3-Clause
#include "bench/estimate/scoring_input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "bench/estimate/bag_origin.hpp"
#include "bench/estimate/scoring_points.hpp"
#include "bench/scoring/score_hints.hpp"
#include "bench/scoring/segment_list.hpp"
#include "core/file_name.hpp"
#include "core/files/kitti.hpp"
#include "core/files/pose_cleaning.hpp"
#include "core/files/text_file.hpp"
#include "core/files/waypoint_times.hpp"
#include "core/median.hpp"
#include "core/text.hpp"
#include "recordings/topics/recording_topics.hpp"
#include "recordings/trajectories/trajectory_file.hpp"

namespace aims {
namespace {

/// "run/odom" of run.bag:/odom, "aims" of out/aims.tum.
std::string name_of(const TrajectoryFile& file) { return file.file.stem().string() + file.topic; }

/// The error of a recording, of a damaged one with what reads the rest: scoring does not.
tl::unexpected<Error> with_copy(const Error& error) {
  if (error.kind != ErrorKind::kRecoverable) return tl::unexpected(error);
  return failure(error.message + " (aims convert IN --recover --out COPY; then score the copy)");
}

/// Gives poses whose stamps are numbers of frames (`is_frame_index`) the stamps of those frames,
/// and notes it; others stay as they are. Numbers count from 0, or from 1 where the last is that of
/// the last frame. Error for a frame without a stamp.
Result<void> stamp_frames(const StampList& times, const std::string& name, Trajectory& poses,
                          std::vector<std::string>& notes) {
  if (!is_frame_index(poses)) return {};
  const auto number_of = [](const StampedPose& pose) {
    return static_cast<std::size_t>(pose.stamp / kSecond);
  };
  const std::size_t last = number_of(poses.back());
  const std::size_t first = number_of(poses.front()) == 1 && last == times.stamps.size() ? 1 : 0;
  if (last - first >= times.stamps.size()) {
    return failure(fmt::format("{}: has a pose of frame {}, but {} has {} stamps", name, last,
                               times.name, times.stamps.size()));
  }
  for (StampedPose& each : poses) each.stamp = times.stamps[number_of(each) - first];
  notes.push_back(fmt::format("{}: its stamps are numbers of frames: those of {} take their place",
                              name, times.name));
  return {};
}

/// Reads a trajectory of the request, unless it is in memory.
Result<TrajectoryFile> trajectory_of(const ScoringRequest& request, const std::string& source,
                                     const TrajectoryFileOptions& options) {
  const auto known = request.in_memory.find(source);
  if (known == request.in_memory.end()) {
    auto read = read_trajectory(source, options);
    if (!read) return with_copy(read.error());
    if (request.times.empty() || options.stamps.empty()) return read;
    auto stamped = stamp_frames(options.stamps.front(), source, read->trajectory, read->notes);
    if (!stamped) return tl::unexpected(stamped.error());
    return read;
  }
  TrajectoryFile file;
  file.trajectory = known->second;
  file.kind = "in memory";
  file.file = source;
  return file;
}

/// Fills in the truth; yields the bag that it is from, or an empty path.
Result<std::filesystem::path> read_truth(const ScoringRequest& request,
                                         const std::vector<StampList>& stamps,
                                         ScoringInput& input) {
  auto file = trajectory_of(request, request.truth,
                            {PoseRules::kStrict, std::string(kTruthImuTopic), stamps});
  if (!file) return tl::unexpected(file.error());
  input.notes.insert(input.notes.end(), file->notes.begin(), file->notes.end());
  input.truth = {name_of(*file),   request.truth,      file->kind, std::move(file->trajectory),
                 file->body_frame, file->has_attitude, {},         std::move(file->dropped)};
  return file->topic.empty() ? std::filesystem::path() : file->file;
}

/// Names made different: a repeated one is numbered.
std::string unique_name(const std::string& name, const std::vector<SourcedTrajectory>& others) {
  std::set<std::string> taken;
  for (const SourcedTrajectory& each : others) taken.insert(each.name);
  std::string unique = name;
  for (int i = 2; taken.contains(unique); ++i) unique = fmt::format("{}#{}", name, i);
  return unique;
}

void note_body(const SourcedTrajectory& truth, const SourcedTrajectory& estimate,
               std::vector<std::string>& notes) {
  const std::string& body = estimate.body_frame;
  const bool of_imu = truth.body_frame.empty() || truth.body_frame.find("imu") != std::string::npos;
  if (body.empty() && !of_imu) {
    notes.push_back(
        fmt::format("the truth is of '{}', and {} names no frame: taken to be of it too "
                    "(--extrinsic)",
                    truth.body_frame, estimate.name));
  }
  if (truth.body_frame.empty() || body.empty() || truth.body_frame == body) return;
  notes.push_back(
      fmt::format("{}: poses of '{}', while the truth's are of '{}'; --extrinsic takes "
                  "one to the other",
                  estimate.name, body, truth.body_frame));
}

tl::unexpected<Error> refuse_offset(const ScoringRequest& request) {
  return failure(fmt::format("--time-offset {}: moves stamps beyond what 64 bits of ns can hold",
                             request.time_offset_s));
}

/// By how many decimals the unit of stamps lies below seconds.
int stamp_decimals(const ScoringRequest& request) {
  if (request.stamp_unit == "ms") return 3;
  if (request.stamp_unit == "us") return 6;
  return request.stamp_unit == "ns" ? 9 : 0;
}

/// The error of an estimate; one of an unlikely stamp with the option that reads it.
tl::unexpected<Error> with_unit(const std::string& message) {
  constexpr std::string_view kLikely = "likely in ";
  const std::size_t at = message.rfind(kLikely);
  if (at == std::string::npos) return failure(message);
  return failure(fmt::format("{}: --stamp-unit {}", message, message.substr(at + kLikely.size())));
}

Result<void> read_estimates(const ScoringRequest& request, std::vector<StampList> stamps,
                            ScoringInput& input) {
  const auto extrinsic = extrinsic_of(request.extrinsic);
  if (!extrinsic) return tl::unexpected(extrinsic.error());
  const Pose T_estimate_body = extrinsic->inverse();
  const Duration offset = from_seconds(request.time_offset_s);
  stamps.push_back({"the truth", {}});
  for (const StampedPose& each : input.truth.trajectory) {
    Time stamp = 0;
    if (__builtin_sub_overflow(each.stamp, offset, &stamp)) return refuse_offset(request);
    stamps.back().stamps.push_back(stamp);
  }
  for (std::size_t i = 0; i < request.estimates.size(); ++i) {
    const std::string& source = request.estimates[i];
    auto file =
        trajectory_of(request, source, {PoseRules::kAsGiven, "", stamps, stamp_decimals(request)});
    if (!file) return with_unit(file.error().message);
    input.notes.insert(input.notes.end(), file->notes.begin(), file->notes.end());
    const bool moved = !request.extrinsic.empty();
    for (StampedPose& each : file->trajectory) {
      if (__builtin_add_overflow(each.stamp, offset, &each.stamp)) return refuse_offset(request);
      if (moved) each.pose = each.pose * T_estimate_body;
    }
    const std::string name = request.names.empty() ? name_of(*file) : request.names[i];
    if (name == "truth") {
      return failure(fmt::format(
          "--estimate {}: 'truth' is the name of the truth; give another with --name", source));
    }
    input.estimates.push_back({unique_name(name, input.estimates), source, file->kind,
                               std::move(file->trajectory), file->body_frame});
    input.estimates.back().T_body_estimate = *extrinsic;
    if (!moved) note_body(input.truth, input.estimates.back(), input.notes);
  }
  return {};
}

/// The file of waypoint times with the segments that its run states, or what the truth's bag holds
/// of its origin.
Result<BagOrigin> origin_of(const ScoringRequest& request, const std::filesystem::path& bag,
                            std::vector<std::string>& notes) {
  if (request.waypoint_times.empty()) return bag.empty() ? BagOrigin{} : bag_origin(bag);
  auto waypoint_times = read_waypoint_times(request.waypoint_times);
  if (!waypoint_times) return tl::unexpected(waypoint_times.error());
  const bool asked = !request.segments.empty() || request.is_configured;
  const StatedSegments stated = asked ? StatedSegments() : segments_beside(request.waypoint_times);
  if (!stated.names.empty()) {
    notes.push_back(fmt::format("segments {}: as {} states", fmt::join(stated.names, ", "),
                                stated.source.string()));
  }
  return BagOrigin{std::move(*waypoint_times), stated.names};
}

Result<std::vector<Segment>> segments_of_request(const ScoringRequest& request,
                                                 const ScoringInput& input) {
  if (request.segments.empty())
    return segments_wanted(input.waypoint_times, input.scoring.segments);
  const auto list = parse_segments(request.segments);
  if (!list) return tl::unexpected(list.error());
  return resolve_segments(*list, input.waypoint_times, input.truth.trajectory);
}

Result<void> read_segments(const ScoringRequest& request, const std::filesystem::path& bag,
                           ScoringInput& input) {
  auto origin = origin_of(request, bag, input.notes);
  if (!origin) return tl::unexpected(origin.error());
  input.waypoint_times = std::move(origin->waypoint_times);
  if (input.scoring.segments.empty()) input.scoring.segments = std::move(origin->segments);
  auto segments = segments_of_request(request, input);
  if (!segments) return tl::unexpected(segments.error());
  input.segments = std::move(*segments);
  return {};
}

/// Whether all attitudes of the truth are the same while an estimate turns by more than 0.2 rad, as
/// where a total station's positions are written as poses.
bool is_constant_attitude(const ScoringInput& input) {
  constexpr std::size_t kFewest = 10;
  constexpr double kTurn = 0.2;
  const Trajectory& truth = input.truth.trajectory;
  if (truth.size() < kFewest) return false;
  const auto differs = [](const Eigen::Quaterniond& first, double angle) {
    return [first, angle](const StampedPose& each) {
      return each.pose.rotation.angularDistance(first) > angle;
    };
  };
  if (std::ranges::any_of(truth, differs(truth.front().pose.rotation, 1e-9))) return false;
  return std::ranges::any_of(input.estimates, [&](const SourcedTrajectory& each) {
    const ValidPart part(each.trajectory);
    const Trajectory& valid = part.poses();
    return !valid.empty() &&
           std::ranges::any_of(valid, differs(valid.front().pose.rotation, kTurn));
  });
}

/// Decides what the truth measures, and how it is compared.
void resolve_truth(const ScoringRequest& request, ScoringInput& input) {
  if (!request.lever_arm.empty() || !request.lever_arms.empty()) input.truth.has_attitude = false;
  resolve_truth_content(input);
  const Trajectory& truth = input.truth.trajectory;
  if (const std::string leaps = leaps_text(truth); !leaps.empty()) {
    input.notes.push_back("truth: " + leaps);
  }
  if (truth.size() < 3 || input.scoring.association != Association::kInterpolated) return;
  std::vector<Duration> steps;
  for (std::size_t i = 1; i < truth.size(); ++i) {
    steps.push_back(truth[i].stamp - truth[i - 1].stamp);
  }
  const Duration middle = *upper_median(std::move(steps));
  if (middle <= from_seconds(input.scoring.max_truth_gap)) return;
  input.scoring.association = Association::kAtTruth;
  input.notes.push_back(fmt::format(
      "truth: {} control points, {:.1f} s apart: the estimates are compared at their stamps",
      truth.size(), to_seconds(middle)));
}

/// KITTI's own poses are of a camera, whose y axis points down.
void note_axes(ScoringInput& input) {
  const auto is_kitti = [](const SourcedTrajectory& each) { return each.kind == kKittiPoses; };
  const bool any = is_kitti(input.truth) ||
                   std::any_of(input.estimates.begin(), input.estimates.end(), is_kitti);
  if (!any || input.scoring.anchor == AlignmentKind::kStartPose) return;
  input.notes.emplace_back(
      "KITTI poses are taken with z up; for a camera's axes (y down) give "
      "--set scoring.anchor=pose");
}

Result<std::vector<StampList>> stamps_of(const std::filesystem::path& times) {
  if (times.empty()) return std::vector<StampList>();
  const auto text = read_text_file(times);
  if (!text) return tl::unexpected(text.error());
  auto stamps = parse_times(*text, times.string());
  if (!stamps) return tl::unexpected(stamps.error());
  return std::vector<StampList>{{times.string(), std::move(*stamps)}};
}

}  // namespace

void resolve_truth_content(ScoringInput& input) {
  TruthContent& content = input.scoring.truth;
  const bool open = content == TruthContent::kAuto;
  if (!input.truth.has_attitude) content = TruthContent::kPosition;
  if (open && content != TruthContent::kPosition && is_constant_attitude(input)) {
    content = TruthContent::kPosition;
    input.notes.emplace_back("truth: its attitude never changes while the estimates turn");
  }
  if (content == TruthContent::kAuto) content = TruthContent::kPose;
  if (content == TruthContent::kPosition) {
    input.notes.emplace_back(
        "truth: of positions alone: aligned by the path, and there are no scores of attitude");
  }
}

Result<ScoringInput> read_scoring_input(const ScoringRequest& request) {
  if (!request.names.empty() && request.names.size() != request.estimates.size()) {
    return failure(fmt::format("--name: expected one for each of {} estimates, found {}",
                               request.estimates.size(), request.names.size()));
  }
  for (const std::string& name : request.names) {
    if (auto right = check_file_name("--name", name); !right) return tl::unexpected(right.error());
  }
  ScoringInput input;
  input.scoring = request.scoring;
  const auto stamps = stamps_of(request.times);
  if (!stamps) return tl::unexpected(stamps.error());
  if (request.truth.empty() == request.end_pose.empty()) {
    return failure("expected --truth or --end-pose, and not both");
  }
  if (!request.truth.empty()) {
    const auto bag = read_truth(request, *stamps, input);
    if (!bag) return tl::unexpected(bag.error());
    if (auto read = read_segments(request, *bag, input); !read) {
      return tl::unexpected(read.error());
    }
  }
  auto done = read_estimates(request, *stamps, input);
  if (done && !request.end_pose.empty()) done = set_markers(request, input);
  if (!done) return tl::unexpected(done.error());
  resolve_truth(request, input);
  done = move_to_points(request, input);
  if (!done) return tl::unexpected(done.error());
  note_axes(input);
  return input;
}

}  // namespace aims
