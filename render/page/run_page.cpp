// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <set>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "bench/scoring/json_text.hpp"
#include "bench/scoring/score_statistics.hpp"
#include "bench/scoring/start_anchor.hpp"
#include "core/files/atomic_file.hpp"
#include "core/series_style.hpp"
#include "core/text.hpp"
#include "render/page/map_cloud.hpp"
#include "render/page/page_data.hpp"
#include "render/page/pages.hpp"
#include "render/page/run_folder.hpp"
#include "render/page/run_series.hpp"
#include "render/page/scene_geometry.hpp"
#include "render/page/series.hpp"
#include "render/page/surface_distance.hpp"
#include "sim/environment/scene_config.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

/// A path that was given in the working directory, as seen from `folder`. One that is not there any
/// more stays as it was given.
std::string seen_from(const fs::path& folder, const fs::path& given) {
  std::error_code code;
  if (given.is_absolute() || !fs::exists(given, code)) return given.string();
  const fs::path there = fs::relative(given, folder, code);
  return code || there.empty() ? given.string() : there.string();
}

/// First parts of the modules of "python:package.module.Class" in the text.
std::set<std::string> python_modules(const std::string& text) {
  constexpr std::string_view kMark = "python:";
  std::set<std::string> modules;
  for (std::size_t at = text.find(kMark); at != std::string::npos; at = text.find(kMark, at + 1)) {
    const std::size_t begin = at + kMark.size();
    const std::size_t end = text.find('.', begin);
    if (end != std::string::npos) modules.insert(text.substr(begin, end - begin));
  }
  return modules;
}

/// The working directory and those of PYTHONPATH.
std::vector<fs::path> python_folders() {
  std::vector<fs::path> folders = {"."};
  const char* path = std::getenv("PYTHONPATH");
  for (const std::string& part : split(path == nullptr ? "" : path, ':')) {
    if (!part.empty()) folders.emplace_back(part);
  }
  return folders;
}

/// "PYTHONPATH=../.. ", with the folders in which the modules lie; empty without any module.
std::string python_path(const std::set<std::string>& modules, const fs::path& folder) {
  std::vector<std::string> folders;
  for (const std::string& module : modules) {
    std::string found = "FOLDER_OF_" + module;
    for (const fs::path& each : python_folders()) {
      std::error_code ignored;
      if (!fs::exists(each / (module + ".py"), ignored) && !fs::exists(each / module, ignored)) {
        continue;
      }
      found = seen_from(folder, each);
      break;
    }
    if (std::ranges::find(folders, found) == folders.end()) folders.push_back(std::move(found));
  }
  if (folders.empty()) return "";
  return fmt::format("PYTHONPATH={} ", shell_word(fmt::format("{}", fmt::join(folders, ":"))));
}

/// The command that repeats the run, called in its folder, with the recording and the folders of
/// classes in Python as seen from there; null for scores of foreign trajectories.
Json repeat_command_json(const RunFolder& run) {
  if (run.config_yaml.empty()) return {};
  const std::string path = python_path(python_modules(run.config_yaml), run.path);
  if (run.estimate.is_object()) {
    const Json bag = member(run.estimate, "bag");
    if (!bag.is_string()) return {};
    return fmt::format("{}aims estimate {} --config config.yaml --out again", path,
                       shell_word(seen_from(run.path, bag.get<std::string>())));
  }
  const Json seed = member(run.scores, "seed");
  const std::string seeds =
      seed.is_number_unsigned() ? fmt::format(" --seed {}", seed.get<std::uint64_t>()) : "";
  return fmt::format("{}aims run config.yaml{} --out again", path, seeds);
}

/// Pictures of a run's folder that its page shows, and what they are.
const std::vector<PagePicture> kPictures = {
    {"robot_start", "The robot near the start"},
    {"robot_middle", "The robot half-way to its farthest point"},
    {"robot_turn", "The robot at its farthest point from the start"},
    {"trajectories", "Trajectories over the plan; height and error over the distance travelled"},
    {"errors", "Position, height and heading error over time"}};
/// Those and, of a recording without truth, the maps that stand in for the 3D view.
std::vector<PagePicture> pictures_of(const RunFolder& run) {
  std::vector<PagePicture> pictures = kPictures;
  if (run.scores.is_object()) return pictures;
  for (const EstimatorFiles& each : run.estimators) {
    pictures.push_back({each.name + "-map-top", "Map of " + each.name + " from above"});
    pictures.push_back({each.name + "-map-side", "Map of " + each.name + " from the side"});
  }
  return pictures;
}
/// Pictures beyond this size are left out [bytes].
constexpr std::uintmax_t kLargestPicture = 512 * 1024;

/// "mine, theirs against truth": of scores of any system, whose scenario is the truth's name.
std::string name_of_scores(const Json& scores, const std::string& truth) {
  constexpr std::size_t kMost = 3;
  const Json estimators = member(scores, "estimators");
  std::string names;
  std::size_t count = 0;
  for (const auto& [name, each] : estimators.items()) {
    if (++count <= kMost) names += (names.empty() ? "" : ", ") + name;
  }
  if (count > kMost) names += fmt::format(" and {} more", count - kMost);
  return fmt::format("{} against {}", names, truth);
}

std::string name_of(const RunFolder& run) {
  if (run.scenario) return run.scenario->name;
  const Json scenario = member(run.scores, "scenario");
  if (scenario.is_string() && is_foreign(run)) {
    return name_of_scores(run.scores, scenario.get<std::string>());
  }
  if (scenario.is_string()) return scenario.get<std::string>();
  const Json bag = member(run.estimate, "bag");
  return bag.is_string() ? fs::path(bag.get<std::string>()).stem().string() : "run";
}

/// What the 3D view draws of the robot [m]; `trunk`: its centre in body axes, the IMU's.
Json body_json(const RobotConfig& robot) {
  const Mounts mounts = nominal_mounts(robot.mounts);
  const Eigen::Vector3d trunk = mounts.T_base_body.inverse().translation;
  return {{"trunk", {trunk.x(), trunk.y(), trunk.z()}},
          {"hip_x", robot.legs.hip_x},
          {"leg_y", robot.legs.hip_y + robot.legs.abduction},
          {"height", robot.gait.body_height}};
}

bool is_corridor(const RunFolder& run) {
  return run.scenario && run.scenario->simulation.scene.kind == SceneKind::kCorridor;
}

Json scenario_json(const RunFolder& run) {
  const bool recorded = run.estimate.is_object();
  const Json& record = recorded ? run.estimate : run.scores;
  return {{"name", name_of(run)},
          {"description", run.scenario ? Json(run.scenario->description) : Json()},
          {"seed", recorded || is_foreign(run) ? Json() : member(run.scores, "seed")},
          {"simulated_s", member(record, recorded ? "recorded_s" : "simulated_s")},
          {"complete", member(record, "complete")},
          {"robot", member(run.scores, "robot")},
          {"corridor", is_corridor(run)},
          {"body", run.scenario ? body_json(run.scenario->simulation.robot) : Json()}};
}

/// The estimators that failed, each with its message.
Json failures_json(const RunFolder& run) {
  const Json of_estimate = member(run.estimate, "failures");
  if (!of_estimate.is_object()) return member(run.scores, "failures");
  Json list = Json::array();
  for (const auto& [name, message] : of_estimate.items()) {
    list.push_back({{"estimator", name}, {"message", message}});
  }
  return list;
}

/// The estimators whose scores are of a part of the run.
Json partial_json(const RunFolder& run) {
  return run.scores.is_object() ? Json(partial_in({0, run.scores})) : Json::array();
}

Json changes_json(const RunFolder& run) {
  return json_array(run.changes, [](const ConfigChange& each) {
    return Json{{"key", each.key},
                {"value", each.value},
                {"default", each.default_value ? Json(*each.default_value) : Json()},
                {"unit", each.unit}};
  });
}

Json diverged_at_json(const RunFolder& run, const std::string& name, double start) {
  const Json scores = member(member(run.scores, "estimators"), name);
  const Json diverged_at = member(scores, "diverged_at_s");
  return diverged_at.is_number() ? Json(diverged_at.get<double>() - start) : Json();
}

/// Poses and lengths of an estimate of a recording; null of other runs.
Json summary_json(const RunFolder& run, const std::string& name) {
  const Json own = member(member(run.estimate, "estimators"), name);
  if (!own.is_object()) return {};
  return {{"poses", member(own, "poses")},
          {"path_m", member(own, "path_m")},
          {"displacement_m", member(own, "displacement_m")}};
}

/// How healthy the estimator called itself; null in folders without it.
Json health_json(const RunFolder& run, const std::string& name) {
  const Json& record = run.estimate.is_object() ? run.estimate : run.scores;
  return member(member(member(record, "estimators"), name), "health");
}

/// Whether a scene has a ceiling; one that is not known may have.
bool may_be_roofed(const Scene* scene) {
  return scene == nullptr ||
         std::ranges::any_of(scene->solids, [](const Solid& solid) { return solid.roof; });
}

/// `scene`: null when it is not known.
Result<Json> estimators_json(const RunFolder& run, const Scene* scene, double start,
                             PageData& page) {
  const auto surface =
      scene != nullptr ? std::optional<SurfaceDistance>(std::in_place, *scene) : std::nullopt;
  const auto maps = static_cast<std::size_t>(
      std::ranges::count_if(run.estimators, [](const auto& each) { return !each.map.empty(); }));
  std::vector<std::string> names;
  for (const EstimatorFiles& each : run.estimators) names.push_back(each.name);
  const std::vector<std::size_t> styles = series_styles(names);
  Json list = Json::array();
  for (const EstimatorFiles& each : run.estimators) {
    auto series = series_json(each, run, start, page);
    if (!series) return series;
    list.push_back(
        {{"name", each.name},
         {"diverged_at", diverged_at_json(run, each.name, start)},
         {"health", health_json(run, each.name)},
         {"summary", summary_json(run, each.name)},
         {"colour_index", styles[list.size()]},
         {"series", std::move(*series)},
         {"map",
          map_json(each.map, start_anchor(each.trajectory, run.truth, run.scoring),
                   surface ? &*surface : nullptr, most_points(maps), may_be_roofed(scene), page)}});
  }
  return list;
}

/// Adds what needs the scene: its geometry, scans, and maps compared with its surface.
Result<void> add_estimators(const RunFolder& run, double start, PageData& page) {
  std::optional<Scene> scene;
  page.json["scene"] = Json();
  if (run.scenario) {
    scene =
        build_scene(run.scenario->simulation.scene, static_cast<std::uint64_t>(run.scenario->seed));
    page.json["scene"] = scene_json(*scene, page);
  }
  const Scene* known = scene ? &*scene : nullptr;
  auto scans = scans_json(run, known, may_be_roofed(known), start, page);
  if (!scans) return tl::unexpected(scans.error());
  page.json["scans"] = std::move(*scans);
  auto estimators = estimators_json(run, known, start, page);
  if (!estimators) return tl::unexpected(estimators.error());
  page.json["estimators"] = std::move(*estimators);
  return {};
}

}  // namespace

Result<PageData> run_page(const fs::path& folder) {
  const auto run = read_run_folder(folder);
  if (!run) return tl::unexpected(run.error());
  const double start = page_start(*run);
  PageData page;
  page.title = name_of(*run);
  if (run->scenario) page.title += fmt::format(", seed {}", run->scenario->seed);
  page.json = {
      {"schema", kPageSchema},
      {"kind", "run"},
      {"title", page.title},
      {"version", member(run->scores.is_object() ? run->scores : run->estimate, "version")},
      {"t0_s", start},
      {"palette", palette_json()},
      {"score_list", score_list_json()},
      {"warnings", member(run->estimate, "warnings")},
      {"reading", member(run->estimate, "notes")},
      {"failures", failures_json(*run)},
      {"scenario", scenario_json(*run)},
      {"command", repeat_command_json(*run)},
      {"config_yaml", run->config_yaml.empty() ? Json() : Json(run->config_yaml)},
      {"config_changes", changes_json(*run)},
      {"scores", run->scores},
      {"partial", partial_json(*run)},
      {"waypoint_times", waypoint_times_json(*run, start)},
      {"truth", truth_json(*run, start, page)}};
  auto localizability = localizability_json(*run, start, page);
  if (!localizability) return tl::unexpected(localizability.error());
  page.json["localizability"] = std::move(*localizability);
  auto legs = legs_json(*run, start, page);
  if (!legs) return tl::unexpected(legs.error());
  page.json["legs"] = std::move(*legs);
  if (auto added = add_estimators(*run, start, page); !added) {
    return tl::unexpected(added.error());
  }
  Json notes = run->notes;
  auto pictures = pictures_json(run->path, pictures_of(*run), kLargestPicture, notes);
  if (!pictures) return tl::unexpected(pictures.error());
  page.json["notes"] = std::move(notes);
  page.json["pictures"] = std::move(*pictures);
  return page;
}

}  // namespace aims
