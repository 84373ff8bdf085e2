// SPDX-License-Identifier: BSD-3-Clause
#include "bench/run/bag_origin.hpp"

#include <fmt/format.h>

#include "bench/run/scenario.hpp"
#include "core/files/waypoint_times.hpp"
#include "core/files/yaml_config.hpp"
#include "recordings/topics/recording_topics.hpp"
#include "recordings/trajectories/bag_trajectory.hpp"

namespace aims {
namespace {

/// The scenario's own choice; none when another version wrote it in words unknown today.
std::vector<std::string> segments_of_scenario(const std::string& yaml) {
  Scenario scenario;
  if (!load_config_text(yaml, std::string(kScenarioTopic), scenario)) return {};
  return scenario.scoring.segments;
}

}  // namespace

Result<BagOrigin> bag_origin(const std::filesystem::path& bag) {
  BagOrigin origin;
  const auto waypoint_times = read_bag_text(bag, std::string(kWaypointTimesTopic));
  if (!waypoint_times) return tl::unexpected(waypoint_times.error());
  if (*waypoint_times) {
    auto parsed = parse_waypoint_times(**waypoint_times,
                                       fmt::format("{}:{}", bag.string(), kWaypointTimesTopic));
    if (!parsed) return tl::unexpected(parsed.error());
    origin.waypoint_times = std::move(*parsed);
  }
  const auto scenario = read_bag_text(bag, std::string(kScenarioTopic));
  if (scenario && *scenario) origin.segments = segments_of_scenario(**scenario);
  return origin;
}

}  // namespace aims
