// SPDX-License-Identifier: BSD-3-Clause
#include "render/page/run_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <utility>

#include "bench/estimate/estimate.hpp"
#include "bench/metrics/association.hpp"
#include "bench/scoring/json_text.hpp"
#include "bench/scoring/result_files.hpp"
#include "core/file_name.hpp"
#include "core/files/atomic_file.hpp"
#include "core/files/ply.hpp"
#include "core/files/tum.hpp"
#include "core/files/waypoint_times.hpp"
#include "render/page/links.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

/// Groups of a scenario that are no setting of the run.
constexpr std::array<std::string_view, 6> kNoSettings = {"name",   "description", "tags.",
                                                         "family", "level",       "expect."};

/// As of a valid pose [m].
constexpr float kFarthestPoint = 1e6F;

/// Of a class in Python: stands for its files, nobody sets it.
constexpr std::string_view kCodeHash = ".code_hash";

bool is_setting(const std::string& key) {
  if (key.ends_with(kCodeHash)) return false;
  return std::none_of(kNoSettings.begin(), kNoSettings.end(),
                      [&](std::string_view prefix) { return (key + ".").starts_with(prefix); });
}

/// What differs between two configurations of one kind.
template <class Config>
std::vector<ConfigChange> changes_between(Config used, Config defaults) {
  std::map<std::string, std::string> default_values;
  for (const Parameter& each : fields_of(defaults).parameters()) {
    default_values[each.key] = each.text();
  }
  std::vector<ConfigChange> changes;
  const Fields fields = fields_of(used);
  for (const Parameter& each : fields.parameters()) {
    const auto standard = default_values.find(each.key);
    const bool known = standard != default_values.end();
    if (!is_setting(each.key) || (known && standard->second == each.text())) continue;
    changes.push_back({each.key, each.text(),
                       known ? std::optional(standard->second) : std::nullopt, each.spec.unit});
  }
  return changes;
}

/// Names come from JSON: only those that a program of ours gives are names of files in the folder.
bool is_file_name(const std::string& name) { return check_file_name("name", name).has_value(); }

void take_names(const Json& document, std::vector<std::string>& names) {
  if (!document.is_object() || !document.contains("estimators")) return;
  for (const auto& [name, unused] : document["estimators"].items()) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
}

std::vector<std::string> estimator_names(const RunFolder& run) {
  std::vector<std::string> names;
  take_names(run.scores, names);
  take_names(run.estimate, names);
  std::vector<std::string> found;
  for (const auto& entry : fs::directory_iterator(run.path)) {
    const std::string stem = entry.path().stem().string();
    const bool estimate = stem != "truth" && !stem.ends_with(".optimized");
    if (entry.path().extension() == ".tum" && estimate) found.push_back(stem);
  }
  std::sort(found.begin(), found.end());
  for (std::string& name : found) {
    if (std::find(names.begin(), names.end(), name) == names.end()) {
      names.push_back(std::move(name));
    }
  }
  return names;
}

/// What `read` yields of the file; nothing where there is none.
template <class Read, class Value>
Result<void> read_into(const fs::path& file, const Read& read, Value& value) {
  if (!fs::exists(file)) return {};
  auto found = read(file);
  if (!found) return tl::unexpected(found.error());
  value = std::move(*found);
  return {};
}

Result<Trajectory> read_valid_part(const fs::path& file) {
  return read_tum(file, PoseRules::kAsGiven).map(valid_part);
}

Result<CsvColumns> read_table(const fs::path& file) { return CsvColumns::read(file); }

Result<std::vector<Eigen::Vector3f>> read_map(const fs::path& file) {
  auto points = read_ply(file);
  if (!points) return points;
  std::erase_if(*points, [](const Eigen::Vector3f& point) {
    return !(point.allFinite() && point.cwiseAbs().maxCoeff() < kFarthestPoint);
  });
  return points;
}

Result<EstimatorFiles> read_files_of(const fs::path& folder, const std::string& name) {
  EstimatorFiles files;
  files.name = name;
  if (!is_file_name(name)) return files;
  auto done = read_into(folder / (name + ".tum"), read_valid_part, files.trajectory);
  if (done) done = read_into(folder / (name + ".diagnostics.csv"), read_table, files.diagnostics);
  if (done) done = read_into(folder / (name + ".map.ply"), read_map, files.map);
  if (!done) return tl::unexpected(done.error());
  return files;
}

Result<void> read_records(RunFolder& run) {
  if (fs::exists(run.path / "scores.json")) {
    auto record = read_record(run.path / "scores.json");
    if (!record) return tl::unexpected(record.error());
    run.scores = std::move(record->scores);
  }
  const fs::path file = run.path / "estimate.json";
  if (!fs::exists(file)) return {};
  const auto text = read_file(file);
  if (!text) return tl::unexpected(text.error());
  auto estimate = parse_json(*text, file.string());
  if (!estimate) return tl::unexpected(estimate.error());
  run.estimate = std::move(*estimate);
  if (run.estimate.is_object()) return {};
  return failure(fmt::format("{}: expected a JSON object", file.string()));
}

/// Takes a configuration that was read, or the note why it was not.
template <class Config>
void take_config(const Result<Config>& config, const Result<Config>& defaults, RunFolder& run) {
  if (!config) {
    run.notes.push_back("Without scene and settings: " + config.error().message);
    return;
  }
  run.scoring = config->scoring;
  if (defaults) run.changes = changes_between(*config, *defaults);
}

/// The default scenario with that scenario's level of the sensors.
Result<Scenario> defaults_at_level(Scenario scenario) {
  std::vector<std::string> settings;
  for (const Parameter& each : fields_of(scenario).parameters()) {
    if (each.key == "sensors" || each.key == "imu_grade") {
      settings.push_back(each.key + "=" + each.text());
    }
  }
  return default_scenario(settings);
}

Result<void> read_config(RunFolder& run) {
  const fs::path file = run.path / "config.yaml";
  if (!fs::exists(file)) {
    if (!is_foreign(run)) {
      run.notes.emplace_back("Without scene and settings: the folder has no config.yaml.");
    }
    return {};
  }
  auto text = read_file(file);
  if (!text) return tl::unexpected(text.error());
  run.config_yaml = std::move(*text);
  if (run.estimate.is_object()) {
    take_config(load_estimate_config(file, {}), load_estimate_config({}, {}), run);
    return {};
  }
  auto scenario = load_scenario(file, {});
  take_config(scenario, scenario ? defaults_at_level(*scenario) : default_scenario({}), run);
  if (scenario) run.scenario = std::move(*scenario);
  return {};
}

}  // namespace

bool is_foreign(const RunFolder& run) {
  return run.scores.is_object() && run.scores.contains("truth") && !run.estimate.is_object();
}

bool holds_run(const fs::path& folder) {
  return fs::exists(folder / "scores.json") || fs::exists(folder / "estimate.json") ||
         (fs::exists(folder / "truth.tum") && fs::exists(folder / "config.yaml"));
}

Result<RunFolder> read_run_folder(const fs::path& folder) {
  if (!holds_run(folder)) {
    return failure(
        fmt::format("{}: expected scores.json or estimate.json, found neither", folder.string()));
  }
  RunFolder run;
  run.path = folder;
  auto done = check_links(folder);
  if (done) done = read_records(run);
  if (done) done = read_config(run);
  if (done) done = read_into(folder / "truth.tum", read_valid_part, run.truth);
  if (done)
    done = read_into(folder / "waypoint_times.csv", read_waypoint_times, run.waypoint_times);
  if (done) done = read_into(folder / "localizability.csv", read_table, run.localizability);
  if (done) done = read_into(folder / "legs.csv", read_table, run.legs);
  if (done) done = read_into(folder / "scans.csv", read_table, run.scans);
  if (!done) return tl::unexpected(done.error());
  for (const std::string& name : estimator_names(run)) {
    auto files = read_files_of(folder, name);
    if (!files) return tl::unexpected(files.error());
    run.estimators.push_back(std::move(*files));
  }
  return run;
}

}  // namespace aims
