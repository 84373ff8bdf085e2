// SPDX-License-Identifier: BSD-3-Clause
#include "bench/run/scoring_input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "bench/run/bag_origin.hpp"
#include "bench/run/segment_list.hpp"
#include "core/file_name.hpp"
#include "core/files/atomic_file.hpp"
#include "core/files/kitti.hpp"
#include "core/files/number_lines.hpp"
#include "core/files/waypoint_times.hpp"
#include "recordings/topics/recording_topics.hpp"
#include "recordings/trajectories/trajectory_file.hpp"

namespace aims {
namespace {

Result<Pose> extrinsic_of(const std::string& text) {
  if (text.empty()) return Pose();
  std::vector<double> v;
  for (const std::string_view word : words_of(text)) {
    if (const auto number = parse_number(word)) v.push_back(*number);
  }
  const bool seven = v.size() == 7 && words_of(text).size() == 7;
  const Eigen::Quaterniond rotation =
      seven ? Eigen::Quaterniond(v[6], v[3], v[4], v[5]) : Eigen::Quaterniond(0.0, 0.0, 0.0, 0.0);
  if (!(std::abs(rotation.norm() - 1.0) < 1e-3)) {
    return failure(
        fmt::format("--extrinsic '{}': expected 'x y z qx qy qz qw' in metres with a "
                    "unit quaternion",
                    text));
  }
  return Pose{rotation.normalized(), {v[0], v[1], v[2]}};
}

/// "run/odom" of run.bag:/odom, "aims" of out/aims.tum.
std::string name_of(const TrajectoryFile& file) { return file.file.stem().string() + file.topic; }

/// Reads a trajectory of the request, unless it is in memory.
Result<TrajectoryFile> trajectory_of(const ScoringRequest& request, const std::string& source,
                                     const TrajectoryFileOptions& options) {
  const auto known = request.in_memory.find(source);
  if (known == request.in_memory.end()) return read_trajectory(source, options);
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
  input.truth = {name_of(*file), request.truth, file->kind, std::move(file->trajectory),
                 file->body_frame};
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
    auto file = trajectory_of(request, source, {PoseRules::kAsGiven, "", stamps});
    if (!file) return tl::unexpected(file.error());
    input.notes.insert(input.notes.end(), file->notes.begin(), file->notes.end());
    const bool moved = !request.extrinsic.empty();
    for (StampedPose& each : file->trajectory) {
      if (__builtin_add_overflow(each.stamp, offset, &each.stamp)) return refuse_offset(request);
      if (moved) each.pose = each.pose * T_estimate_body;
    }
    const std::string name = request.names.empty() ? name_of(*file) : request.names[i];
    input.estimates.push_back({unique_name(name, input.estimates), source, file->kind,
                               std::move(file->trajectory), file->body_frame});
    if (!moved) note_body(input.truth, input.estimates.back(), input.notes);
  }
  return {};
}

/// The file of waypoint times with the segments that its run states, or what the truth's bag holds
/// of its origin.
Result<BagOrigin> origin_of(const ScoringRequest& request, const std::filesystem::path& bag,
                            std::vector<std::string>& notes) {
  if (request.waypoint_times.empty()) return bag.empty() ? BagOrigin{} : bag_origin(bag);
  const auto text = read_file(request.waypoint_times);
  if (!text) return tl::unexpected(text.error());
  auto waypoint_times = parse_waypoint_times(*text, request.waypoint_times.string());
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

/// KITTI's own poses are of a camera, whose y axis points down.
void note_axes(ScoringInput& input) {
  const auto is_kitti = [](const SourcedTrajectory& each) { return each.kind == "KITTI poses"; };
  const bool any = is_kitti(input.truth) ||
                   std::any_of(input.estimates.begin(), input.estimates.end(), is_kitti);
  if (!any || input.scoring.anchor == AlignmentKind::kStartPose) return;
  input.notes.emplace_back(
      "KITTI poses are taken with z up; for a camera's axes (y down) give "
      "--set scoring.anchor=pose");
}

Result<std::vector<StampList>> stamps_of(const std::filesystem::path& times) {
  if (times.empty()) return std::vector<StampList>();
  const auto text = read_file(times);
  if (!text) return tl::unexpected(text.error());
  auto stamps = parse_times(*text, times.string());
  if (!stamps) return tl::unexpected(stamps.error());
  return std::vector<StampList>{{times.string(), std::move(*stamps)}};
}

}  // namespace

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
  const auto bag = read_truth(request, *stamps, input);
  if (!bag) return tl::unexpected(bag.error());
  auto origin = origin_of(request, *bag, input.notes);
  if (!origin) return tl::unexpected(origin.error());
  input.waypoint_times = std::move(origin->waypoint_times);
  if (input.scoring.segments.empty()) input.scoring.segments = std::move(origin->segments);
  auto segments = segments_of_request(request, input);
  if (!segments) return tl::unexpected(segments.error());
  input.segments = std::move(*segments);
  if (auto read = read_estimates(request, *stamps, input); !read) {
    return tl::unexpected(read.error());
  }
  note_axes(input);
  return input;
}

}  // namespace aims
