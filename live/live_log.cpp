// SPDX-License-Identifier: BSD-3-Clause
#include "live/live_log.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <system_error>

#include "core/files/atomic_file.hpp"
#include "core/files/ply.hpp"
#include "core/files/tum.hpp"

namespace aims {
namespace {

using Json = nlohmann::ordered_json;

Json warnings_json(const RecordingSetup& setup) {
  Json json = Json::array();
  for (const ReadingWarning& each : setup.warnings) json.push_back(each.text);
  return json;
}

}  // namespace

Result<LiveLog> LiveLog::create(const std::filesystem::path& folder, const std::string& name) {
  LiveLog log;
  if (folder.empty()) return log;
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return failure(fmt::format("{}: {}", folder.string(), error.message()));
  log.folder_ = folder;
  log.name_ = name;
  const auto open = [&](std::ofstream& file, const std::string& ending) -> Result<void> {
    const auto path = folder / (name + ending);
    std::error_code none;
    if (std::filesystem::file_size(path, none) > 0 && !none) {
      return failure(fmt::format("{} exists: expected a folder without it", path.string()));
    }
    file.open(path);
    if (!file) return failure(fmt::format("{}: cannot be written", path.string()));
    return {};
  };
  if (auto ok = open(log.poses_, ".tum"); !ok) return tl::unexpected(ok.error());
  if (auto ok = open(log.health_, ".health.csv"); !ok) return tl::unexpected(ok.error());
  return log;
}

void LiveLog::add(std::span<const StampedPose> poses, std::span<const HealthRow> health) {
  if (folder_.empty() || !state_) return;
  for (const StampedPose& each : poses) {
    if (count_++ == 0) first_ = last_ = each.pose.translation;
    path_m_ += (each.pose.translation - last_).norm();
    last_ = each.pose.translation;
  }
  for (const HealthRow& row : health) {
    health_table_.add(to_seconds(row.stamp)).add(name_of(row.state));
    health_table_.add(fmt::format("{}", fmt::join(row.reasons, "; "))).add(row.position_sigma);
    health_table_.end_row();
  }
  poses_ << tum_text(poses) << std::flush;
  health_ << health_table_.take_text() << std::flush;
  if (poses_ && health_) return;
  state_ = failure(fmt::format("{}: cannot be written: no space left?", folder_.string()));
}

Result<void> LiveLog::save_map(std::span<const Eigen::Vector3f> points) const {
  if (folder_.empty() || points.empty()) return {};
  return write_ply(folder_ / (name_ + ".map.ply"), points);
}

Result<void> LiveLog::save_summary(const RecordingReader& reader, const EstimatorResult& result,
                                   bool complete) const {
  if (folder_.empty()) return {};
  const RecordingSetup& setup = reader.setup();
  const Json json = {{"schema", "aims.estimate/1"},
                     {"bag", "live topics"},
                     {"complete", complete},
                     {"recorded_s", to_seconds(reader.position())},
                     {"topics",
                      {{"lidar", setup.topics.lidar},
                       {"imu", setup.topics.imu},
                       {"leg_odometry", setup.topics.leg_odometry},
                       {"joint_states", setup.topics.joint_states},
                       {"contacts", setup.topics.contacts}}},
                     {"notes", setup.notes},
                     {"warnings", warnings_json(setup)},
                     {"counts", reader.counts()},
                     {"estimators",
                      {{name_,
                        {{"poses", count_},
                         {"path_m", path_m_},
                         {"displacement_m", (last_ - first_).norm()},
                         {"counts", result.counts}}}}}};
  return write_file_atomically(folder_ / "estimate.json",
                               json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace aims
