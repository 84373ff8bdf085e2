// SPDX-License-Identifier: BSD-3-Clause
#include "live/live_log.hpp"

#include <fmt/format.h>

#include <system_error>

#include "core/files/tum.hpp"

namespace aims {

LiveLog::LiveLog() : health_table_({"stamp_s", "state", "reasons", "position_sigma_m"}) {}

Result<LiveLog> LiveLog::create(const std::filesystem::path& folder, const std::string& name) {
  LiveLog log;
  if (folder.empty()) return log;
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return failure(fmt::format("{}: {}", folder.string(), error.message()));
  log.folder_ = folder;
  const auto open = [&](std::ofstream& file, const std::string& ending) -> Result<void> {
    const auto path = folder / (name + ending);
    if (std::filesystem::exists(path)) {
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

Result<void> LiveLog::add(std::span<const StampedPose> poses, std::span<const HealthRow> health) {
  if (folder_.empty()) return {};
  for (const HealthRow& row : health) {
    health_table_.add(to_seconds(row.stamp)).add(name_of(row.state));
    health_table_.add(fmt::format("{}", fmt::join(row.reasons, "; "))).add(row.position_sigma);
    health_table_.end_row();
  }
  poses_ << tum_text(poses) << std::flush;
  health_ << health_table_.take_text() << std::flush;
  if (poses_ && health_) return {};
  return failure(fmt::format("{}: cannot be written: no space left?", folder_.string()));
}

}  // namespace aims
