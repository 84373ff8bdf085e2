// SPDX-License-Identifier: BSD-3-Clause
#include "bench/estimate/bag_origin.hpp"

#include <fmt/format.h>

#include <string_view>
#include <system_error>

#include "bench/metrics/scores.hpp"
#include "core/files/text_file.hpp"
#include "core/files/waypoint_times.hpp"
#include "core/files/yaml_config.hpp"
#include "recordings/source/recording_file.hpp"
#include "recordings/topics/recording_topics.hpp"
#include "recordings/trajectories/bag_trajectory.hpp"

namespace aims {
namespace {

/// The scenario's own choice; none when another version wrote it in words unknown today.
std::vector<std::string> segments_of_scenario(const std::string& yaml) {
  ScoreConfig scoring;
  const auto fields = [&scoring] {
    Fields all;
    all.group("scoring", scoring);
    return all;
  };
  if (!load_group_text(yaml, std::string(kScenarioTopic), "scoring", fields)) return {};
  return scoring.segments;
}

/// The scenario's choice as a bag holds it.
std::vector<std::string> segments_in_bag(const std::filesystem::path& bag,
                                         const std::vector<std::filesystem::path>& with = {}) {
  const auto scenario = read_bag_text(bag, std::string(kScenarioTopic), {.with = with});
  return scenario && *scenario ? segments_of_scenario(**scenario) : std::vector<std::string>();
}

}  // namespace

Result<BagOrigin> bag_origin(const std::filesystem::path& bag,
                             const std::vector<std::filesystem::path>& with) {
  BagOrigin origin;
  const auto waypoint_times = read_bag_text(bag, std::string(kWaypointTimesTopic), {.with = with});
  if (!waypoint_times) return tl::unexpected(waypoint_times.error());
  if (*waypoint_times) {
    auto parsed = parse_waypoint_times(**waypoint_times,
                                       fmt::format("{}:{}", bag.string(), kWaypointTimesTopic));
    if (!parsed) return tl::unexpected(parsed.error());
    origin.waypoint_times = std::move(*parsed);
  }
  origin.segments = segments_in_bag(bag, with);
  return origin;
}

StatedSegments segments_beside(const std::filesystem::path& waypoint_times) {
  namespace fs = std::filesystem;
  constexpr std::string_view kName = "waypoint_times.csv";
  const std::string name = waypoint_times.filename().string();
  const fs::path folder = waypoint_times.parent_path();
  std::error_code code;
  if (name == kName) {
    const fs::path config = folder / "config.yaml";
    if (!fs::is_regular_file(config, code)) return {};
    const auto text = read_text_file(config);
    return {text ? segments_of_scenario(*text) : std::vector<std::string>(), config};
  }
  if (!name.ends_with(fmt::format(".{}", kName))) return {};
  const fs::path stem = folder / name.substr(0, name.size() - kName.size() - 1);
  for (const char* extension : {".bag", ".mcap", ""}) {
    const fs::path recording = fs::path(stem) += extension;
    if (format_by_content(recording)) return {segments_in_bag(recording), recording};
  }
  return {};
}

}  // namespace aims
