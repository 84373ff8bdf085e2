// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "bench/cli/commands.hpp"
#include "bench/cli/exit_code.hpp"
#include "bench/cli/interrupt.hpp"
#include "bench/cli/options.hpp"
#include "bench/cli/progress_display.hpp"
#include "bench/run/estimate.hpp"
#include "bench/run/estimate_report.hpp"
#include "core/files/output_folder.hpp"
#include "estimator/estimator_spec.hpp"
#include "render/results/pictures.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

struct EstimateArguments {
  std::string bag;
  std::string config;
  std::vector<std::string> estimators;
  std::vector<std::string> topics;
  std::vector<std::string> overrides;
  std::string out;
  int jobs = default_jobs();
  bool recover = false;
  bool overwrite = false;
  bool quiet = false;
  bool no_pictures = false;
};

Result<EstimateConfig> config_of(const EstimateArguments& arguments) {
  std::vector<std::string> overrides;
  if (!arguments.estimators.empty()) {
    overrides.push_back(estimators_setting(joined_specs(arguments.estimators)));
  }
  for (const std::string& topic : arguments.topics) {
    if (topic.find('=') == std::string::npos) {
      return failure(
          fmt::format("--topics: expected SENSOR=TOPIC, e.g. lidar=/points, got '{}'", topic));
    }
    overrides.push_back("recording.topics." + topic);
  }
  overrides.insert(overrides.end(), arguments.overrides.begin(), arguments.overrides.end());
  return load_estimate_config(arguments.config, overrides);
}

/// out/NAME-estimate, beside nothing that a run writes.
fs::path folder_of(const EstimateArguments& arguments) {
  if (!arguments.out.empty()) return arguments.out;
  return fs::path("out") / (fs::path(arguments.bag).stem().string() + "-estimate");
}

void print_report(const EstimateResult& result, const fs::path& folder,
                  const std::vector<std::string>& warnings) {
  for (const std::string& note : result.setup.notes) fmt::print("note: {}\n", note);
  for (const auto& [event, count] : result.counts) fmt::print("note: {}: {}\n", event, count);
  fmt::print("{}, {:.1f} s\n{}\n", result.bag.string(), result.recorded_s,
             to_text(estimate_table(result)));
  for (const std::string& warning : warnings) fmt::print("warning: {}\n", warning);
  if (!result.complete) fmt::print("interrupted: the results hold what was read until then\n");
  fmt::print("results: {}\n", (folder / "").string());
  for (const fs::path& picture : pictures_in(folder)) fmt::print("  {}\n", picture.string());
}

int estimate_command(const EstimateArguments& arguments) {
  const auto config = config_of(arguments);
  if (!config) return bad_input("estimate", config.error());
  auto folder = OutputFolder::create(folder_of(arguments), arguments.overwrite);
  if (!folder) return bad_input("estimate", folder.error());

  watch_interrupt();
  ProgressDisplay display(arguments.bag, arguments.quiet, "read");
  const EstimateOptions options = {arguments.bag, arguments.recover, arguments.jobs};
  const auto result = estimate(*config, options, [&](const Progress& progress) {
    display.show(std::nullopt, progress);
    return !interrupted();
  });
  display.close();
  if (!result) return bad_input("estimate", result.error());

  if (auto ok = write_estimate(*config, *result, folder->path()); !ok) {
    return bad_input("estimate", ok.error());
  }
  std::vector<std::string> warnings;
  if (!arguments.no_pictures) {
    const auto drawn = draw_estimate(*result, folder->path());
    if (!drawn) warnings.push_back(drawn.error().message);
  }
  if (auto ok = folder->commit(); !ok) return bad_input("estimate", ok.error());
  print_report(*result, folder->final_path(), warnings);
  if (result->broken) return bad_input("estimate", *result->broken);
  return result->complete ? kOk : kInterrupted;
}

}  // namespace

void add_estimate_command(CLI::App& app, int& exit_code) {
  auto* command = app.add_subcommand("estimate", "Run estimators over a recorded bag");
  auto arguments = std::make_shared<EstimateArguments>();
  command->add_option("bag", arguments->bag, "ROS 1 bag, simulated or from a robot")->required();
  command
      ->add_option("--estimator,--estimators", arguments->estimators,
                   "Estimators to run, e.g. aims,lio (aims) or\n"
                   "loose=aims+leg.scale_sigma=0.1")
      ->delimiter(',');
  command
      ->add_option("--topics", arguments->topics,
                   "SENSOR=TOPIC, e.g. lidar=/points,imu=/imu/data; sensors: lidar, imu, "
                   "leg_odometry, joint_states, contacts, truth")
      ->delimiter(',');
  command->add_option("--config", arguments->config,
                      "YAML file with recording, estimator, scoring");
  add_repeatable(*command, "--set", arguments->overrides, "key=value on top; repeatable");
  command->add_option("--out", arguments->out, "Folder for the results (out/NAME-estimate)");
  add_jobs_option(*command, arguments->jobs, "Threads; the trajectories do not depend on it");
  command->add_flag("--recover", arguments->recover, "Read what is whole in a broken bag");
  command->add_flag("--overwrite", arguments->overwrite, "Replace results that exist");
  command->add_flag("--quiet", arguments->quiet, "No progress, the table alone");
  command->add_flag("--no-pictures", arguments->no_pictures, "Draw nothing");
  command->footer(
      "Examples:\n"
      "  aims estimate walk.bag\n"
      "  aims estimate robot.bag --estimators aims,lio --topics lidar=/velodyne_points,imu=/imu\n"
      "  aims estimate robot.bag --set recording.T_imu_lidar.override_tf=true \\\n"
      "      --set recording.T_imu_lidar.translation=[0.2,0,0.1]");
  command->callback([arguments, &exit_code] { exit_code = estimate_command(*arguments); });
}

}  // namespace aims
