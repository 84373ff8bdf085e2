// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/frames/recorded_frames.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <numbers>

#include "recordings/frames/fixed_transform.hpp"

namespace aims {
namespace {

/// Of a configuration in plain form, which `with_plain_extrinsics` made.
Pose pose_of(const ExtrinsicConfig& configured) {
  if (configured.quaternion_xyzw.size() == 4) {
    const std::vector<double>& q = configured.quaternion_xyzw;
    return {Eigen::Quaterniond(q[3], q[0], q[1], q[2]), configured.translation};
  }
  const Eigen::Vector3d rpy = configured.rotation_rpy_deg * (std::numbers::pi / 180.0);
  return {rotation_of_rpy(rpy.x(), rpy.y(), rpy.z()), configured.translation};
}

void warn_of(const std::optional<FrameTree::Contradiction>& found, std::string_view how,
             ReadingNotes& notes) {
  if (!found) return;
  notes.warn(fmt::format("tf contradicts itself: {} -> {}", found->from, found->to),
             fmt::format("tf {} {} -> {}, {:.3g} m and {:.3g} deg apart: the first is used (set "
                         "T_imu_lidar or T_imu_base)",
                         how, found->from, found->to, found->distance,
                         found->angle * (180.0 / std::numbers::pi)));
}

/// Warns of a sensor that no robot is large enough for.
void warn_of_distance(const Pose& pose, const std::string& from, const std::string& to,
                      std::string_view key, ReadingNotes& notes) {
  constexpr double kFarthest = 5.0;  // [m]
  const double distance = pose.translation.norm();
  if (distance < kFarthest) return;
  notes.warn(fmt::format("{} is far away", key),
             fmt::format("tf puts '{}' {:.4g} m from '{}', expected less than {:.0f} m: are its "
                         "translations in mm? Set recording.{}",
                         to, distance, from, kFarthest, key),
             key == "T_imu_lidar" ? WarnedSensor::kLidar : WarnedSensor::kLegs);
}

}  // namespace

void RecordedFrames::add(const MessageView& message, bool fixed) {
  EventCounts counted_below;
  if (fixed) fixed_.add(message, counted_below);
  all_.add(message, counts_);
}

std::optional<Pose> RecordedFrames::find(const std::string& from, const std::string& to,
                                         ReadingNotes& notes) const {
  if (from.empty() || to.empty()) return std::nullopt;
  if (auto pose = fixed_.transform(from, to)) {
    warn_of(fixed_.contradiction(from, to), "states two poses of", notes);
    return pose;
  }
  auto pose = all_.transform(from, to);
  warn_of(all_.contradiction(from, to), "moves", notes);
  if (pose) {
    notes.push_back(fmt::format("{}: from /tf at the start, assumed fixed",
                                fmt::join(all_.chain(from, to), " -> ")));
  }
  return pose;
}

Pose RecordedFrames::extrinsic(const ExtrinsicConfig& configured, const std::string& from,
                               const std::string& to, std::string_view key,
                               ReadingNotes& notes) const {
  if (configured.override_tf) return pose_of(configured);
  if (!from.empty() && from == to) {
    notes.push_back(fmt::format("frame '{}' is both ends of {}: identity", from, key));
  }
  if (auto pose = find(from, to, notes)) {
    warn_of_distance(*pose, from, to, key, notes);
    return *pose;
  }
  const auto named = [](const std::string& frame) {
    return frame.empty() ? std::string("a frame that no message names")
                         : fmt::format("'{}'", frame);
  };
  notes.warn(fmt::format("{} unknown", key),
             fmt::format("NO TRANSFORM from {} to {} in tf: identity is assumed. Set "
                         "recording.{}.translation and rotation_rpy_deg, or .file to a "
                         "calibration, or name the frames",
                         named(from), named(to), key),
             key == "T_imu_lidar" ? WarnedSensor::kLidar : WarnedSensor::kLegs,
             WarningKind::kNoTransform);
  return {};
}

std::string RecordedFrames::moved(const std::string& before, const std::string& now) const {
  constexpr double kSameM = 1e-4;
  constexpr double kSameDeg = 0.01;
  const auto T = all_.transform(before, now);
  if (!T) return "no transform between them is in tf";
  const double distance = T->translation.norm();
  const double angle = Eigen::AngleAxisd(T->rotation).angle() * (180.0 / std::numbers::pi);
  if (distance < kSameM && angle < kSameDeg) return "";
  return fmt::format("which lies {:.3f} m and {:.1f} deg from it in tf", distance, angle);
}

}  // namespace aims
