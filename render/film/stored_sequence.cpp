// SPDX-License-Identifier: BSD-3-Clause
#include "render/film/stored_sequence.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "bench/run/start_anchor.hpp"
#include "core/files/atomic_file.hpp"
#include "core/files/ply.hpp"
#include "core/files/tum.hpp"
#include "core/files/waypoint_times.hpp"
#include "estimator/estimator_spec.hpp"
#include "sim/environment/scene_config.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

constexpr Duration kDrawnSpacing = 100 * kMillisecond;

fs::path map_file(const fs::path& folder, const std::string& name) {
  return folder / (name + ".map.ply");
}

/// Puts `mapped` in front, or the first that has a map.
Result<void> order(std::vector<std::string>& names, const fs::path& folder,
                   const std::string& mapped) {
  const auto first = std::find_if(names.begin(), names.end(), [&](const std::string& name) {
    return mapped.empty() ? fs::exists(map_file(folder, name)) : name == mapped;
  });
  if (first == names.end() && !mapped.empty()) {
    return failure(fmt::format("{}: no estimator '{}'; there are {}", folder.string(), mapped,
                               fmt::join(names, ", ")));
  }
  if (first != names.end()) std::rotate(names.begin(), first, first + 1);
  return {};
}

Result<void> add_estimates(FilmedSequence& sequence, const fs::path& folder,
                           const std::vector<std::string>& names, const ScoreConfig& scoring) {
  for (const std::string& name : names) {
    const auto estimate = read_tum(folder / (name + ".tum"), PoseRules::kAsGiven);
    if (!estimate) return tl::unexpected(estimate.error());
    const bool first = sequence.estimates.empty();
    sequence.estimates.push_back({name, anchored(*estimate, sequence.truth, scoring)});
    if (!first || !fs::exists(map_file(folder, name))) continue;
    const auto points = read_ply(map_file(folder, name));
    if (!points) return tl::unexpected(points.error());
    const Pose T_world_odom = start_anchor(*estimate, sequence.truth, scoring);
    for (const Eigen::Vector3f& point : *points) {
      sequence.map.push_back({(T_world_odom * point.cast<double>()).cast<float>(), 0});
    }
  }
  return {};
}

}  // namespace

bool holds_sequence(const fs::path& folder) {
  return fs::is_regular_file(folder / "config.yaml") && fs::is_regular_file(folder / "truth.tum");
}

Result<FilmedSequence> stored_sequence(const fs::path& folder, const std::string& mapped) {
  const auto scenario = load_scenario(folder / "config.yaml", {});
  if (!scenario) return tl::unexpected(scenario.error());
  FilmedSequence sequence;
  sequence.scenario = scenario->name;
  sequence.robot = scenario->simulation.robot.model;
  sequence.seed = static_cast<std::uint64_t>(scenario->seed);
  sequence.scene = build_scene(scenario->simulation.scene, sequence.seed);
  auto truth = read_tum(folder / "truth.tum");
  if (!truth) return tl::unexpected(truth.error());
  const auto text = read_file(folder / "waypoint_times.csv");
  if (!text) return tl::unexpected(text.error());
  auto waypoint_times = parse_waypoint_times(*text, (folder / "waypoint_times.csv").string());
  if (!waypoint_times) return tl::unexpected(waypoint_times.error());
  sequence.waypoint_times = std::move(*waypoint_times);
  std::vector<std::string> names = labels_of(scenario->run);
  if (auto ordered = order(names, folder, mapped); !ordered) return tl::unexpected(ordered.error());
  sequence.truth = std::move(*truth);
  if (auto added = add_estimates(sequence, folder, names, scenario->scoring); !added) {
    return tl::unexpected(added.error());
  }
  sequence.truth = thinned(sequence.truth, kDrawnSpacing);
  return sequence;
}

}  // namespace aims
