// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/frames/configured_extrinsic.hpp"

#include <fmt/format.h>

#include <numbers>

#include "core/text.hpp"
#include "recordings/frames/calibration_file.hpp"
#include "recordings/frames/static_transform.hpp"

namespace aims {
namespace {

constexpr double kRad = std::numbers::pi / 180.0;

std::string place_of(std::string_view key, std::string_view field) {
  return fmt::format("recording.{}.{}", key, field);
}

/// The values as written, before their direction.
Result<Pose> written_pose(const ExtrinsicConfig& config, std::string_view key) {
  if (!config.matrix.empty()) return pose_of_matrix(config.matrix, place_of(key, "matrix"));
  Pose pose{rotation_of_rpy(kRad * config.rotation_rpy_deg.x(), kRad * config.rotation_rpy_deg.y(),
                            kRad * config.rotation_rpy_deg.z()),
            config.translation};
  Result<Eigen::Quaterniond> rotation = pose.rotation;
  if (!config.quaternion_xyzw.empty()) {
    rotation = rotation_of_quaternion(config.quaternion_xyzw, place_of(key, "quaternion_xyzw"));
  }
  if (const std::vector<double>& q = config.quaternion_wxyz; q.size() == 4) {
    rotation = rotation_of_quaternion({{q[1], q[2], q[3], q[0]}}, place_of(key, "quaternion_wxyz"));
  } else if (!q.empty()) {
    rotation = rotation_of_quaternion(q, place_of(key, "quaternion_wxyz"));
  }
  if (!config.rotation_matrix.empty()) {
    rotation = rotation_of_matrix(config.rotation_matrix, place_of(key, "rotation_matrix"));
  }
  if (!rotation) return tl::unexpected(rotation.error());
  pose.rotation = *rotation;
  return pose;
}

bool names_imu(std::string_view frame) {
  return lower_case(frame).find("imu") != std::string::npos;
}

/// Of a static_transform_publisher, whose frames tell the direction where one names the IMU.
Result<Pose> published_pose(const ExtrinsicConfig& config, std::string_view key) {
  const std::string place = place_of(key, "static_transform");
  const auto parsed = parse_static_transform(config.static_transform, place);
  if (!parsed) return tl::unexpected(parsed.error());
  const bool asked = config.direction == ExtrinsicDirection::kImuInSensor;
  const bool imu_first = names_imu(parsed->parent), imu_last = names_imu(parsed->child);
  if (asked && imu_first && !imu_last) {
    return failure(
        fmt::format("{}: '{}' in '{}' is the pose of the sensor in the IMU, which the "
                    "direction contradicts",
                    place, parsed->child, parsed->parent));
  }
  const bool turned = asked || (imu_last && !imu_first);
  return turned ? parsed->T_parent_child.inverse() : parsed->T_parent_child;
}

}  // namespace

Result<Pose> configured_extrinsic(const ExtrinsicConfig& config, std::string_view key) {
  const bool turned = config.direction == ExtrinsicDirection::kImuInSensor;
  if (static_cast<int>(config.has_numbers()) + static_cast<int>(!config.file.empty()) +
          static_cast<int>(!config.static_transform.empty()) >
      1) {
    return failure(fmt::format(
        "recording.{}: expected one of numbers, static_transform and file, found several", key));
  }
  if (!config.file.empty()) {
    const std::vector<std::string>& names = config.file_frames;
    if (!names.empty() && names.size() != 2) {
      return failure(place_of(key, "file_frames") + ": expected two names, [IMU, sensor]");
    }
    return read_extrinsic(config.file, names.empty() ? "" : names[0],
                          names.empty() ? "" : names[1]);
  }
  if (!config.static_transform.empty()) return published_pose(config, key);
  auto pose = written_pose(config, key);
  if (pose && turned) return pose->inverse();
  return pose;
}

Result<RecordingConfig> with_plain_extrinsics(RecordingConfig config) {
  const auto make_plain = [](ExtrinsicConfig& each, std::string_view key) -> Result<void> {
    const bool plain = each.override_tf && each.direction == ExtrinsicDirection::kSensorInImu;
    const bool angles = each.matrix.empty() && each.rotation_matrix.empty() &&
                        each.quaternion_xyzw.empty() && each.quaternion_wxyz.empty() &&
                        each.static_transform.empty() && each.file.empty();
    if (!each.is_given() || (plain && angles)) return {};
    const auto pose = configured_extrinsic(each, key);
    if (!pose) return tl::unexpected(pose.error());
    const Eigen::Quaterniond& q = pose->rotation;
    each = ExtrinsicConfig();
    each.override_tf = true;
    each.translation = pose->translation;
    each.quaternion_xyzw = {q.x(), q.y(), q.z(), q.w()};
    return {};
  };
  if (auto done = make_plain(config.T_imu_lidar, "T_imu_lidar"); !done) {
    return tl::unexpected(done.error());
  }
  if (auto done = make_plain(config.T_imu_base, "T_imu_base"); !done) {
    return tl::unexpected(done.error());
  }
  return config;
}

Result<void> check_extrinsics(const RecordingConfig& config,
                              std::span<const AssignedKey> assigned) {
  const auto check = [&](const ExtrinsicConfig& each, std::string_view key) -> Result<void> {
    if (!each.has_numbers()) return {};
    const auto pose = configured_extrinsic(each, key);
    if (pose) return {};
    std::string place;  // the last one counts
    for (const AssignedKey& set : assigned) {
      if (pose.error().message.starts_with(set.key + ":")) place = set.place;
    }
    return failure(place + pose.error().message);
  };
  auto right = check(config.T_imu_lidar, "T_imu_lidar");
  return right ? check(config.T_imu_base, "T_imu_base") : right;
}

void find_calibrations(RecordingConfig& config, const std::filesystem::path& folder) {
  for (ExtrinsicConfig* each : {&config.T_imu_lidar, &config.T_imu_base}) {
    if (each->file.empty() || std::filesystem::path(each->file).is_absolute()) continue;
    const std::filesystem::path beside = folder / each->file;
    std::error_code ignored;
    const bool elsewhere =
        std::filesystem::exists(each->file, ignored) && !std::filesystem::exists(beside, ignored);
    if (!elsewhere) each->file = beside.string();
  }
}

}  // namespace aims
