// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <memory>
#include <string>

#include "bench/estimate/scoring_input.hpp"
#include "bench/scenario/scenario.hpp"
#include "bench/scoring/evo_export.hpp"
#include "bench/scoring/run_failure.hpp"
#include "bench/scoring/trajectory_summary.hpp"
#include "cli/commands.hpp"
#include "cli/json_output.hpp"
#include "cli/options.hpp"
#include "cli/progress.hpp"
#include "cli/terminal.hpp"
#include "core/file_name.hpp"
#include "core/files/output_folder.hpp"
#include "core/files/tum.hpp"
#include "render/page/page.hpp"
#include "render/results/pictures.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

struct ScoreArguments {
  SharedOptions shared;
  ScoringRequest request;
  fs::path config;
  bool no_pictures = false;
  bool no_page = false;
  bool json = false;
  bool evo = false;
};

void print_scores(const TrajectoryScores& scores, const fs::path& folder) {
  print_out("{}\n", to_text(trajectory_source_table(scores)));
  print_scores_table(trajectory_score_table(scores), "scores.md");
  print_out("{}", score_legend(scores));
  const RunRecord record = record_of(scores);
  for (const std::string& line : failure_lines({&record, 1})) print_out("no success: {}\n", line);
  for (const std::string& note : scores.notes) print_out("note: {}\n", note);
  print_out("results: {}\n", (folder / "").string());
  for (const auto& picture : pictures_in(folder)) print_out("  {}\n", picture.string());
  if (fs::exists(folder / kPageFile)) print_out("page: {}\n", (folder / kPageFile).string());
}

/// The trajectories as they were compared, for the page and for other tools: those whose names can
/// be names of files.
Result<void> write_trajectories(const TrajectoryScores& scores, const fs::path& folder) {
  constexpr const char* kTruth = "truth";
  auto written = write_tum(folder / "truth.tum", scores.truth.trajectory);
  for (const ScoredEstimate& each : scores.estimates) {
    const std::string& name = each.given.name;  // of a topic, "bag/odom"
    if (name == kTruth || !check_file_name("--name", name)) continue;
    if (written) written = write_tum(folder / (name + ".tum"), each.in_truth_frame);
  }
  return written;
}

/// Pictures and page; what cannot be drawn is a warning: the scores are there.
void draw(const TrajectoryScores& scores, const fs::path& folder, const ScoreArguments& arguments) {
  Result<void> drawn;
  if (!arguments.no_pictures) {
    DrawDisplay display(arguments.shared.quiet);
    drawn = draw_trajectory_pictures(scores, folder, display.observer());
  }
  if (!drawn) print_error("warning: " + drawn.error().message);
  if (arguments.no_page) return;
  const auto page = write_page_of(folder, arguments.shared.quiet);
  if (!page) print_error("warning: " + page.error().message);
}

int score_command(const ScoreArguments& arguments) {
  const SharedOptions& shared = arguments.shared;
  ScoringRequest request = arguments.request;
  const auto scoring = scoring_config(arguments.config, shared.settings);
  if (!scoring) return refuse("score", scoring.error(), arguments.json);
  request.scoring = *scoring;
  request.is_configured = !arguments.config.empty();
  auto input = read_scoring_input(request);
  if (!input) return refuse("score", input.error(), arguments.json);
  const auto scores = score_trajectories(std::move(*input));
  if (!scores) return refuse("score", scores.error(), arguments.json);
  if (auto ok = check_compared(*scores); !ok) return refuse("score", ok.error(), arguments.json);
  auto folder = OutputFolder::create(shared.out, shared.overwrite);
  if (!folder) return refuse("score", folder.error(), arguments.json);
  auto written = write_trajectory_scores(*scores, folder->path());
  if (written) written = write_trajectories(*scores, folder->path());
  if (written && arguments.evo) written = write_evo_archives(*scores, folder->path());
  if (!written) return refuse("score", written.error(), arguments.json);
  draw(*scores, folder->path(), arguments);
  if (auto committed = folder->commit(); !committed)
    return refuse("score", committed.error(), arguments.json);
  if (arguments.json) {
    print_json(record_of(*scores).scores);
  } else {
    print_scores(*scores, folder->final_path());
  }
  const auto too_little = [&](const ScoredEstimate& each) {
    return covers_too_little(each, scores->scoring);
  };
  return std::ranges::any_of(scores->estimates, too_little) ? kInvalidRun : kOk;
}

void add_inputs(Command& command, ScoreArguments& arguments) {
  ScoringRequest& request = arguments.request;
  command.option("--truth", request.truth, "Ground-truth trajectory, or positions of a point");
  command.repeatable("--estimate", request.estimates, "Estimated trajectory", Presence::kRequired);
  command.list("--name", request.names, "Name of each estimate, in their order, e.g. mine,theirs");
  command.option("--times", request.times, "Stamps of KITTI poses: a file with one per line [s]");
  command.option("--time-offset", request.time_offset_s, {-4e9, 4e9},
                 "Added to the stamps of the estimates [s] (0)");
  command.choice("--stamp-unit", request.stamp_unit, {"s", "ms", "us", "ns"},
                 "Unit of the stamps of estimates in text files (s)");
  command.option("--extrinsic", request.extrinsic,
                 "'x y z qx qy qz qw': pose of the frame of the estimates in\n"
                 "the body frame of the truth, e.g. of the LiDAR in the IMU");
  command.option("--lever-arm", request.lever_arm,
                 "'x y z': the point that the truth measures, e.g. a prism, in the\n"
                 "frame of the estimates [m]; estimate: the one that fits best");
  command.option("--end-pose", request.end_pose,
                 "In place of --truth: pose of the end in the frame of the start,\n"
                 "'x y z qx qy qz qw', or 'x y z', e.g. '0 0 0' of a closed route");
  command.option("--waypoint-times", request.waypoint_times,
                 "waypoint_times.csv of a run: the reference points of M_list");
  command.option("--segments", request.segments,
                 "Segments of M_list: a-b=12.5:110.2 in seconds of the truth,\n"
                 "or a-d between waypoints; separated by commas");
  command.option("--config", arguments.config, "YAML file; its group scoring is used");
}

}  // namespace

void declare_score(Command command, const fs::path& /*scenarios*/) {
  auto arguments = std::make_shared<ScoreArguments>();
  SharedOptions& shared = arguments->shared;
  shared.out = "out/score";
  add_inputs(command, *arguments);
  add_settings(command, shared, "the configuration: keys of scoring", kGroupSetting);
  add_out(command, shared, "out/score");
  add_overwrite(command, shared);
  command.flag("--evo", arguments->evo, "Write NAME.evo.zip, which evo_res reads");
  command.flag("--no-pictures", arguments->no_pictures, "Draw no pictures");
  command.flag("--no-page", arguments->no_page, "Write no HTML page");
  add_json(command, arguments->json);
  add_quiet(command, shared);
  command.footer(
      "A trajectory is a file of TUM lines, of KITTI poses, CSV, BAG:/TOPIC (nav_msgs/Odometry,\n"
      "nav_msgs/Path, geometry_msgs/PoseStamped and others with poses), or BAG:/tf:PARENT,CHILD; "
      "a\n"
      "truth may also be positions: lines 'stamp x y z' or geometry_msgs/PointStamped.\n"
      "Exit code 4: an estimate covers less of the truth than scoring.min_coverage (0.5).\n"
      "Examples:\n"
      "  aims score --truth truth.tum --estimate mine.tum --waypoint-times waypoint_times.csv\n"
      "  aims score --truth run.bag:/ground_truth/lidar --estimate loam.txt --estimate lio.tum \\\n"
      "    --segments a-b=12.5:110.2,b-a=115:220 --out out/lidars");
  command.action([arguments] { return score_command(*arguments); });
}

}  // namespace aims
