// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bench/estimate/estimate.hpp"
#include "bench/estimate/estimate_summary.hpp"
#include "bench/scoring/health_summary.hpp"
#include "bench/scoring/run_failure.hpp"
#include "bench/scoring/trajectory_summary.hpp"
#include "cli/commands.hpp"
#include "cli/json_output.hpp"
#include "cli/options.hpp"
#include "cli/progress.hpp"
#include "cli/terminal.hpp"
#include "core/files/output_folder.hpp"
#include "render/page/page.hpp"
#include "render/results/pictures.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

struct EstimateArguments {
  SharedOptions shared;
  std::vector<std::string> files;
  std::string config;
  std::vector<std::string> topics;
  bool recover = false;
  bool no_pictures = false;
  bool no_page = false;
  bool json = false;
};

Result<EstimateConfig> config_of(const EstimateArguments& arguments) {
  const auto overrides = overrides_of(arguments.shared, arguments.topics);
  if (!overrides) return tl::unexpected(overrides.error());
  return load_estimate_config(arguments.config, *overrides);
}

/// out/NAME-estimate, which no other command writes.
fs::path folder_of(const EstimateArguments& arguments) {
  if (!arguments.shared.out.empty()) return arguments.shared.out;
  return fs::path("out") / (fs::path(arguments.files.front()).stem().string() + "-estimate");
}

/// What of the robot's calibration the data have overruled.
void print_contradictions(const EstimatorOutcome& outcome) {
  constexpr std::string_view kCount = "calibration.contradicted.";
  for (const auto& [name, count] : outcome.result.counts) {
    if (!name.starts_with(kCount)) continue;
    print_out("warning: {}: the recording contradicts the calibration's {}, which was dropped\n",
              outcome.name, name.substr(kCount.size()));
  }
}

void print_results(const EstimateResult& result, const fs::path& folder,
                   const std::vector<std::string>& warnings) {
  for (const std::string& note : result.setup.notes) print_out("note: {}\n", note);
  for (const auto& [event, count] : result.counts) print_out("note: {}: {}\n", event, count);
  print_out("{}, {:.1f} s\n", result.bag.string(), result.recorded_s);
  print_scores_table(estimate_table(result), result.scores ? "scores.json" : "estimate.json");
  print_out("{}\n", result.scores ? score_legend(*result.scores) : "");
  if (result.scores) {
    const RunRecord record = record_of(*result.scores);
    for (const std::string& line : failure_lines({&record, 1})) print_out("no success: {}\n", line);
  }
  for (const EstimatorOutcome& each : result.estimators) {
    if (each.totals.poses == 0) {
      for (const auto& [event, count] : each.result.counts) {
        print_out("note: {}: {}: {}\n", each.name, event, count);
      }
    }
    const std::string health = text_of(each.totals.health);
    if (!health.empty()) print_out("health: {}: {}\n", each.name, health);
    const auto unnoticed = result.healthy_while_wrong_s.find(each.name);
    if (unnoticed != result.healthy_while_wrong_s.end() && unnoticed->second >= kLeastUnnoticed) {
      print_out("health: {}: healthy for {:.1f} s while wrong\n", each.name, unnoticed->second);
    }
  }
  for (const ReadingWarning& each : result.setup.warnings) print_out("warning: {}\n", each.text);
  for (const EstimatorOutcome& each : result.estimators) print_contradictions(each);
  for (const std::string& warning : warnings) print_out("warning: {}\n", warning);
  if (!result.complete) print_out("interrupted: the results end where reading was stopped\n");
  print_out("results: {}\n", (folder / "").string());
  for (const fs::path& picture : pictures_in(folder)) print_out("  {}\n", picture.string());
  if (fs::exists(folder / kPageFile)) print_out("page: {}\n", (folder / kPageFile).string());
}

/// Error code when an estimator broke, or when an estimate must not be used: it has no poses, or
/// was invalid at some time.
int exit_code_of(const EstimateResult& result) {
  for (const EstimatorFailure& each : result.failures) {
    print_failure(fmt::format("aims estimate: {}: FAILED: {}", each.name, each.message));
  }
  if (!result.failures.empty()) return kExpectationFailed;
  int code = kOk;
  for (const std::string& name : result.without_rings) {
    code = kInvalidRun;
    print_error(
        fmt::format("aims estimate: {}: needs the ring of each point, which the recording "
                    "lacks: its estimate must not be used",
                    name));
  }
  for (const EstimatorOutcome& each : result.estimators) {
    const bool no_poses = each.totals.poses == 0;
    if (each.totals.scans > 10 && each.totals.path_m == 0.0) {
      code = kInvalidRun;
      print_error(fmt::format("aims estimate: {}: never moved in {} scans: no scan was matched",
                              each.name, each.totals.scans));
    }
    if (!no_poses && each.totals.health.worst != HealthState::kInvalid) continue;
    code = kInvalidRun;
    print_error(fmt::format("aims estimate: {}: {}", each.name,
                            no_poses ? "no poses; see the counts and the health above"
                                     : "invalid at some time; see " + each.name + ".health.csv"));
  }
  return code;
}

Result<Answer> estimate_command(const EstimateArguments& arguments) {
  const SharedOptions& shared = arguments.shared;
  const auto config = config_of(arguments);
  if (!config) return tl::unexpected(config.error());
  watch_interrupt();
  auto folder = OutputFolder::create(folder_of(arguments), shared.overwrite);
  if (!folder) return tl::unexpected(folder.error());
  ProgressDisplay display(arguments.files.front(), shared.quiet, "read");
  const EstimateOptions options = {
      arguments.files.front(), arguments.recover,        shared.jobs,
      folder->path(),          further(arguments.files), shared.calibration};
  const auto result = estimate(*config, options, [&](const Progress& progress) {
    return display.show(std::nullopt, progress);
  });
  display.close();
  if (!result) return tl::unexpected(result.error());

  if (auto ok = write_estimate(*config, *result, folder->path()); !ok) {
    return tl::unexpected(ok.error());
  }
  std::vector<std::string> warnings;
  if (!arguments.no_pictures) {
    DrawDisplay drawing(shared.quiet);
    const auto drawn = draw_estimate(*result, folder->path(), drawing.observer());
    if (!drawn) warnings.push_back(drawn.error().message);
  }
  if (!arguments.no_page) {
    const auto page = write_page_of(folder->path(), shared.quiet);
    if (!page) warnings.push_back(page.error().message);
  }
  if (auto ok = folder->commit(); !ok) return tl::unexpected(ok.error());
  print_results(*result, folder->final_path(), warnings);
  Json document = estimate_json(*result);
  document["out"] = folder->final_path().string();
  document["scores"] = result->scores ? estimate_record(*result).scores : Json();
  const int code = result->broken     ? bad_input("estimate", *result->broken)
                   : result->complete ? exit_code_of(*result)
                                      : interrupted_code();
  return Answer{code, std::move(document)};
}

}  // namespace

void declare_estimate(Command command, const fs::path& /*scenarios*/) {
  auto arguments = std::make_shared<EstimateArguments>();
  SharedOptions& shared = arguments->shared;
  command.arguments("bag", arguments->files,
                    "Recording, simulated or of a robot: files or folders, merged by record time",
                    Presence::kRequired);
  command.option("--config", arguments->config,
                 "YAML file with the groups recording, estimator, scoring");
  command.list("--topics", arguments->topics,
               "SENSOR=TOPIC, e.g. lidar=/points,imu=/imu/data; sensors:\n"
               "lidar, imu, leg_odometry, joint_states, contacts, truth");
  add_estimators(command, shared, "aims_d");
  add_calibration(command, shared);
  add_settings(command, shared, "the configuration", kGroupSetting);
  add_out(command, shared, "out/NAME-estimate");
  add_overwrite(command, shared);
  add_jobs(command, shared);
  add_quiet(command, shared);
  command.flag("--recover", arguments->recover, "Read the intact part of a damaged bag");
  command.flag("--no-pictures", arguments->no_pictures, "Draw no pictures");
  command.flag("--no-page", arguments->no_page, "Write no HTML page");
  add_json(command, arguments->json);
  command.footer(
      "Examples:\n"
      "  aims estimate corridor.bag\n"
      "  aims estimate robot.bag --estimators aims_d,lio --topics lidar=/velodyne_points,imu=/imu\n"
      "  aims estimate robot.bag --set recording.T_imu_lidar.override_tf=true \\\n"
      "      --set recording.T_imu_lidar.translation=[0.2,0,0.1]");
  command.action([arguments] {
    return answer("estimate", arguments->json, [&] { return estimate_command(*arguments); });
  });
}

}  // namespace aims
