// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scenario/scenario.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <string_view>
#include <vector>

#include "bench/estimate/python_classes.hpp"
#include "bench/scenario/model_sheets.hpp"
#include "bench/scenario/scenario_head.hpp"
#include "bench/scenario/score_keys.hpp"
#include "core/file_name.hpp"
#include "core/files/config_dump.hpp"
#include "core/files/yaml_config.hpp"
#include "core/files/yaml_document.hpp"
#include "estimator/estimator_spec.hpp"
#include "estimator/registry.hpp"
#include "sim/robot/scene_route.hpp"
#include "sim/simulation.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

using LevelOptions = std::vector<std::pair<std::string, SensorLevel>>;

const LevelOptions& level_options() {
  static const LevelOptions options = {{"ideal", SensorLevel::kIdeal},
                                       {"datasheet", SensorLevel::kDatasheet},
                                       {"field", SensorLevel::kField}};
  return options;
}

/// Error for an expectation of an estimator that there is not.
Result<void> check_estimator(std::string_view key, const std::string& name,
                             const Scenario& scenario) {
  std::vector<std::string> known = estimator_names();
  for (const std::string& label : labels_of(scenario.run)) {
    if (std::find(known.begin(), known.end(), label) == known.end()) known.push_back(label);
  }
  if (std::find(known.begin(), known.end(), name) != known.end()) return {};
  const std::string near = near_match(name, known);
  return failure(fmt::format("{}: no estimator '{}'; expected one of {}{}", key, name,
                             fmt::join(known, ", "),
                             near.empty() ? "" : fmt::format("; did you mean '{}'?", near)));
}

/// Error for a segment that the route has no two points for.
Result<void> check_segments(const Scenario& scenario) {
  const auto& points = scenario.simulation.route.points;
  for (std::size_t i = 0; i < scenario.scoring.segments.size(); ++i) {
    const std::string& name = scenario.scoring.segments[i];
    bool exists = false;
    for (std::size_t from = 0; from < points.size(); ++from) {
      for (std::size_t to = from + 1; to < points.size(); ++to) {
        exists = exists || points[from].name + "-" + points[to].name == name;
      }
    }
    if (exists) continue;
    return failure(fmt::format(
        "scoring.segments: expected FROM-TO of two of the route's points in order, got '{}'",
        name));
  }
  return {};
}

/// Error for names that cannot be those of files and folders of results.
Result<void> check_names(const Scenario& scenario) {
  if (auto name = check_file_name("name", scenario.name); !name) return name;
  if (scenario.family.empty()) return {};
  return check_file_name("family", scenario.family);
}

/// Error for an expectation whose level of the sensors there is not.
Result<void> check_level(std::size_t index, const Expectation& expectation) {
  const auto& levels = level_options();
  const bool known =
      expectation.sensors.empty() || std::ranges::any_of(levels, [&](const auto& level) {
        return level.first == expectation.sensors;
      });
  if (known) return {};
  return failure(fmt::format("expect.{}.sensors: expected ideal, datasheet or field, got '{}'",
                             index, expectation.sensors));
}

/// Leaves out the expectations that are held at other levels of the sensors.
void keep_expectations_of_level(Scenario& scenario) {
  const auto& levels = level_options();
  const auto level = std::ranges::find_if(
      levels, [&](const auto& each) { return each.second == scenario.sensors; });
  std::erase_if(scenario.expect, [&](const Expectation& each) {
    return !each.sensors.empty() && each.sensors != level->first;
  });
}

/// Applies the presets that `chosen` names, which lie below the scenario's own keys.
Result<void> apply_presets(const Scenario& chosen, Scenario& scenario) {
  for (const SensorPreset& preset : sensor_presets(chosen.sensors, chosen.imu_grade)) {
    const std::string name = fmt::format("models/sensors/{}.yaml", preset.name);
    if (auto ok = load_config_text(preset.text, name, scenario); !ok) return ok;
  }
  const auto sheet =
      apply_lidar_model(chosen.simulation.lidar.model, chosen.sensors, scenario.simulation.lidar);
  if (!sheet) return tl::unexpected(sheet.error());
  const auto robot =
      apply_robot_model(chosen.simulation.robot.model, chosen.sensors, scenario.simulation);
  if (!robot) return tl::unexpected(robot.error());
  return {};
}

/// Error for a mode that the LiDAR's model does not have.
Result<void> check_lidar(const Scenario& scenario) {
  LidarConfig of_model;
  const auto sheet = apply_lidar_model(scenario.simulation.lidar.model, scenario.sensors, of_model);
  if (!sheet) return tl::unexpected(sheet.error());
  return check_lidar_mode(*sheet, scenario.simulation.lidar);
}

/// `start` as `load` leaves it, on top of the sensor presets that it chooses.
template <class Load>
Result<Scenario> on_presets(Scenario start, std::vector<AssignedKey>& assigned, const Load& load) {
  start.sensors = SensorLevel::kField;
  Scenario chosen = start;
  if (auto ok = load(chosen, nullptr); !ok) return tl::unexpected(ok.error());
  if (auto ok = apply_presets(chosen, start); !ok) return tl::unexpected(ok.error());
  if (auto ok = load(start, &assigned); !ok) return tl::unexpected(ok.error());
  return start;
}

Result<void> check(const Scenario& scenario) {
  if (auto names = check_names(scenario); !names) return names;
  if (scenario.run.empty()) return failure("run: expected at least one estimator");
  if (auto lidar = check_lidar(scenario); !lidar) return lidar;
  if (auto draws = check_draws(scenario); !draws) return draws;
  if (auto segments = check_segments(scenario); !segments) return segments;
  if (auto specs = check_estimator_specs(scenario.run); !specs) {
    return failure("run: " + specs.error().message);
  }
  for (std::size_t i = 0; i < scenario.expect.size(); ++i) {
    const std::string key = fmt::format("expect.{}.estimator", i);
    const Expectation& expectation = scenario.expect[i];
    const std::string score = fmt::format("expect.{}.score", i);
    if (auto level = check_level(i, expectation); !level) return level;
    const bool of_run = expectation.estimator.empty();
    auto known = of_run ? check_run_score(score, expectation.score, scenario)
                        : check_estimator(key, expectation.estimator, scenario);
    if (known && !of_run) known = check_score(score, expectation.score, scenario);
    if (!known) return known;
    if (expectation.min == -kNoLimit && expectation.max == kNoLimit) {
      return failure(fmt::format("expect.{}: expected a limit, max or min", i));
    }
    if (expectation.min > expectation.max) {
      return failure(fmt::format("expect.{}.min: is above max, so that nothing can pass", i));
    }
  }
  return {};
}

/// Sets the points of a route along the scene, so that its segments are known.
void follow_scene(Scenario& scenario) {
  SimulationConfig& simulation = scenario.simulation;
  simulation.route = route_in(simulation.scene, simulation.route);
}

/// Error for a setting without effect.
Result<void> check_effects_in(Scenario& scenario, std::vector<AssignedKey> assigned) {
  const bool run_chosen = std::ranges::any_of(scenario.overrides, is_run_setting);
  return check_effects(fields_of(scenario), std::move(assigned), run_chosen, scenario.run,
                       scenario.estimators);
}

}  // namespace

void describe(Fields& f, Expectation& e) {
  f.text(
      "estimator", e.estimator,
      {.meaning = "estimator whose score is limited; absent: a score of the run, e.g. robot.fell"});
  f.text("score", e.score, {.meaning = "key inside its scores, e.g. m_list_percent.a-b"});
  f.text("sensors", e.sensors,
         {.meaning = "level of the sensors at which it applies; absent: each"});
  f.number(
      "max", e.max,
      {.unit = "as the score", .range = within(kNoLimit), .meaning = "largest value that passes"});
  f.number(
      "min", e.min,
      {.unit = "as the score", .range = within(kNoLimit), .meaning = "smallest value that passes"});
  f.choice("statistic", e.statistic,
           {{"worst", ExpectationStatistic::kWorst},
            {"median", ExpectationStatistic::kMedian},
            {"mean", ExpectationStatistic::kMean}},
           {.meaning = "what of the score over several seeds is limited"});
}

void describe(Fields& f, Scenario& s) {
  describe_head(f, s);
  f.integer(
      "seed", s.seed,
      {.unit = "-", .range = in_range(0, 2147483647), .meaning = "seed of every random stream"});
  f.texts("run", s.run,
          {.meaning = "estimators that run on the stream: NAME or LABEL=NAME+key=value"});
  f.choice("sensors", s.sensors, level_options(),
           {.meaning = "Realism of the sensors: presets below the scenario's own keys.",
            .source = "models/sensors"});
  f.choice("imu_grade", s.imu_grade,
           {{"of_level", ImuGrade::kOfLevel},
            {"ideal", ImuGrade::kIdeal},
            {"mems", ImuGrade::kMems},
            {"industrial", ImuGrade::kIndustrial}},
           {.meaning = "Part whose figures the IMU has, in place of the level's.",
            .source = "models/sensors"});
  describe(f, s.simulation);
  f.list("draw", s.draw, "quantities of the simulation that each seed draws anew");
  describe_estimators(f, s.run, s.estimators);
  f.group("scoring", s.scoring);
  f.list("expect", s.expect, "limits that a run must hold");
}

Error located(const Scenario& scenario, const Error& error) {
  if (scenario.file.empty()) return error;
  return {with_position(scenario.file, error.message, scenario.folder)};
}

Result<void> check_simulation(const Scenario& scenario, std::uint64_t seed) {
  const auto walk = check_walk(scenario_of_seed(scenario, seed).simulation, seed);
  if (!walk) return tl::unexpected(located(scenario, walk.error()));
  return {};
}

std::optional<std::string> route_warning(const Scenario& scenario) {
  const SceneKind kind = scenario.simulation.scene.kind;
  const auto is_set = [&](const std::string& begin) {
    return std::ranges::any_of(scenario.overrides,
                               [&](const std::string& each) { return each.starts_with(begin); });
  };
  if (scenario.simulation.route.follow_scene || is_set("route.")) return std::nullopt;
  if (!is_set(std::string(length_key(kind)) + "=")) return std::nullopt;
  return "the route is as before; " + route_hint(kind);
}

std::vector<std::string> settings_of(const Scenario& scenario) {
  std::vector<std::string> settings = scenario.overrides;
  std::erase_if(settings, [](const std::string& each) { return is_run_setting(each); });
  return settings;
}

std::string settings_markdown(const std::vector<std::string>& settings) {
  return fmt::format("Set on top of the scenario: `{}`.\n", fmt::join(settings, "`, `"));
}

Result<Scenario> load_scenario(const fs::path& file, std::span<const std::string> overrides,
                               const fs::path& folder) {
  Scenario scenario;
  scenario.file = file;
  scenario.folder = folder;
  scenario.overrides.assign(overrides.begin(), overrides.end());
  scenario.name = file.stem().string();
  const YamlFiles files(folder);
  const auto run = choose_run(file, overrides, files, scenario.run, scenario.estimators);
  if (!run) return tl::unexpected(located(scenario, run.error()));
  std::vector<AssignedKey> assigned;
  std::size_t of_file = 0;  // of the assigned keys; settings follow
  auto loaded = on_presets(std::move(scenario), assigned,
                           [&](Scenario& into, std::vector<AssignedKey>* keys) {
                             into.run = run->of_file;
                             auto read = load_config(file, into, keys, files);
                             if (keys != nullptr) of_file = keys->size();
                             into.run = run->all;
                             return read ? apply_overrides(into, overrides, keys, files) : read;
                           });
  if (!loaded) return loaded;
  drop_set_draws(std::span(assigned).subspan(of_file), loaded->draw);
  if (loaded->simulation.sensor_draw == "scenario") loaded->simulation.sensor_draw = loaded->name;
  follow_scene(*loaded);
  if (auto valid = check(*loaded); !valid) {
    return tl::unexpected(located(*loaded, valid.error()));
  }
  keep_expectations_of_level(*loaded);
  if (auto acts = check_effects_in(*loaded, std::move(assigned)); !acts) {
    return tl::unexpected(acts.error());
  }
  return loaded;
}

Result<Scenario> default_scenario(std::span<const std::string> overrides) {
  Scenario scenario;
  scenario.name = "default";
  scenario.overrides.assign(overrides.begin(), overrides.end());
  const YamlFiles files;
  auto run = choose_run({}, overrides, files, scenario.run, scenario.estimators);
  if (!run) return tl::unexpected(run.error());
  scenario.run = std::move(run->all);
  std::vector<AssignedKey> assigned;
  auto loaded = on_presets(std::move(scenario), assigned,
                           [&](Scenario& into, std::vector<AssignedKey>* keys) {
                             return apply_overrides(into, overrides, keys, files);
                           });
  if (!loaded) return loaded;
  follow_scene(*loaded);
  if (auto acts = check_effects_in(*loaded, std::move(assigned)); !acts) {
    return tl::unexpected(acts.error());
  }
  return loaded;
}

std::string config_text(const Scenario& scenario, bool annotated) {
  Scenario copy = scenario;
  const Fields fields = fields_of(copy);
  return annotated ? dump_annotated_config(fields) : dump_config(fields);
}

namespace {

constexpr std::string_view kWithSettings = "With changed settings: ";

/// The description, which was written of the file, with what was set on top.
std::string description_with_settings(const Scenario& scenario) {
  std::vector<std::string> settings = settings_of(scenario);
  if (std::ranges::any_of(settings,
                          [](const auto& each) { return each.starts_with("description="); })) {
    return scenario.description;
  }
  std::erase_if(settings, [](const auto& each) {
    return each.starts_with("estimators.") || each.starts_with("seed=");
  });
  if (settings.empty()) return scenario.description;
  std::string text = scenario.description;
  if (!text.empty()) text += text.ends_with('.') ? " " : ". ";
  return text + fmt::format("{}{}.", kWithSettings, fmt::join(settings, ", "));
}

}  // namespace

std::string effective_config(const Scenario& scenario, std::uint64_t seed) {
  Scenario effective = scenario_of_seed(scenario, seed);
  effective.seed = static_cast<int>(seed);
  effective.description = description_with_settings(scenario);
  return config_text(effective);
}

Result<fs::path> find_scenario(const std::string& given, const fs::path& folder) {
  if (fs::is_regular_file(given)) return fs::path(given);
  const fs::path by_path = folder / (given + ".yaml");
  if (fs::is_regular_file(by_path)) return by_path;
  const auto files = scenario_files(folder);
  if (!files) return tl::unexpected(files.error());
  std::vector<std::string> names;
  for (const fs::path& file : *files) {
    names.push_back(file.stem().string());
    if (names.back() == given) return file;
  }
  const std::string near = near_match(fs::path(given).stem().string(), names);
  return failure(fmt::format("{}: no such scenario file, and no scenario of that name in {}{}",
                             given, folder.string(),
                             near.empty() ? "" : fmt::format("; did you mean '{}'?", near)));
}

Result<std::vector<fs::path>> scenario_files(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code ignored;
  for (const auto& entry : fs::recursive_directory_iterator(folder, ignored)) {
    if (entry.path().extension() == ".yaml") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  std::map<std::string, fs::path> by_name;
  for (const fs::path& file : files) {
    const auto [other, is_new] = by_name.emplace(file.stem().string(), file);
    if (is_new) continue;
    return failure(fmt::format("{} and {}: two scenarios of the same name; rename one",
                               other->second.string(), file.string()));
  }
  return files;
}

namespace {

/// The part of a configuration that scoring reads.
struct ScoringSettings {
  ScoreConfig scoring;
};

void describe(Fields& fields, ScoringSettings& settings) {
  fields.group("scoring", settings.scoring);
}

}  // namespace

Result<ScoreConfig> scoring_config(const std::filesystem::path& file,
                                   std::span<const std::string> overrides) {
  ScoringSettings settings;
  if (!file.empty()) {
    Scenario scenario;
    if (auto loaded = load_config(file, scenario); !loaded) return tl::unexpected(loaded.error());
    settings.scoring = scenario.scoring;
  }
  auto applied = apply_overrides(settings, overrides);
  if (!applied) return tl::unexpected(applied.error());
  return settings.scoring;
}

std::string description_without_settings(const std::string& description) {
  std::string text = description.substr(0, description.rfind(kWithSettings));
  while (text.ends_with(' ')) text.pop_back();
  return text;
}

}  // namespace aims
