// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <memory>
#include <string>

#include "bench/cli/commands.hpp"
#include "bench/cli/exit_code.hpp"
#include "bench/cli/options.hpp"
#include "bench/run/scoring_input.hpp"
#include "bench/run/trajectory_report.hpp"
#include "render/results/pictures.hpp"

namespace aims {
namespace {

struct ScoreArguments {
  ScoringRequest request;
  std::string out = "out/score";
  bool overwrite = false;
  bool no_pictures = false;
};

void print_report(const TrajectoryScores& scores, const TrajectoryReport& report) {
  fmt::print("{}\n{}\n{}", to_text(trajectory_source_table(scores)),
             to_text(trajectory_score_table(scores)), score_legend(scores));
  for (const std::string& note : scores.notes) fmt::print("note: {}\n", note);
  for (const std::string& warning : report.warnings) fmt::print("warning: {}\n", warning);
  fmt::print("results: {}\n", (report.folder / "").string());
  for (const auto& picture : pictures_in(report.folder)) fmt::print("  {}\n", picture.string());
}

int score_command(const ScoreArguments& arguments) {
  auto input = read_scoring_input(arguments.request);
  if (!input) return bad_input("score", input.error());
  const auto scores = score_trajectories(std::move(*input));
  if (!scores) return bad_input("score", scores.error());
  const auto report = write_trajectory_report(
      *scores, {arguments.out, arguments.overwrite, !arguments.no_pictures});
  if (!report) return bad_input("score", report.error());
  print_report(*scores, *report);
  return kOk;
}

void add_inputs(CLI::App& command, ScoringRequest& request) {
  command.add_option("--truth", request.truth, "True trajectory")->required();
  add_repeatable(command, "--estimate", request.estimates, "Estimated trajectory; repeatable")
      ->required();
  add_repeatable(command, "--name", request.names, "Name of each estimate, in their order");
  command.add_option("--times", request.times, "Stamps of KITTI poses, one in seconds a line");
  command.add_option("--time-offset", request.time_offset_s,
                     "Seconds added to the stamps of the estimates");
  command.add_option("--extrinsic", request.extrinsic,
                     "'x y z qx qy qz qw': pose of the estimates' frame in the truth's body, as of "
                     "the LiDAR on the IMU");
}

void add_settings(CLI::App& command, ScoringRequest& request) {
  command.add_option("--waypoint-times", request.waypoint_times,
                     "waypoint_times.csv of a run: the reference points of M_list");
  command.add_option("--segments", request.segments,
                     "Ways that have an M_list: a-b=12.5:110.2 in seconds of the truth's stamps, "
                     "or a-d between waypoint_times; several with commas");
  command.add_option("--config", request.config, "YAML whose group 'scoring' counts");
  add_repeatable(command, "--set", request.overrides, "scoring.key=value; repeatable");
}

}  // namespace

void add_score_command(CLI::App& app, int& exit_code) {
  auto* command =
      app.add_subcommand("score", "Score the trajectories of any system against a truth");
  auto arguments = std::make_shared<ScoreArguments>();
  add_inputs(*command, arguments->request);
  add_settings(*command, arguments->request);
  command->add_option("--out", arguments->out, "Folder for the results (out/score)");
  command->add_flag("--overwrite", arguments->overwrite, "Replace results that exist");
  command->add_flag("--no-pictures", arguments->no_pictures, "Draw nothing");
  command->footer(
      "A trajectory is a file of TUM lines, of KITTI poses, or run.bag:/topic (nav_msgs/Odometry,\n"
      "nav_msgs/Path, geometry_msgs/PoseStamped and the like). Examples:\n"
      "  aims score --truth truth.tum --estimate mine.tum --waypoint-times waypoint_times.csv\n"
      "  aims score --truth run.bag:/ground_truth/lidar --estimate loam.txt --estimate lio.tum \\\n"
      "    --segments a-b=12.5:110.2,b-a=115:220 --out out/lidars");
  command->callback([arguments, &exit_code] { exit_code = score_command(*arguments); });
}

}  // namespace aims
