// SPDX-License-Identifier: BSD-3-Clause
#include "bench/run/experiment.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "core/files/tum.hpp"
#include "tests/bench/run/short_walk.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;
using test::keep_going;
using test::short_walk;

Json read_json(const fs::path& file) { return Json::parse(std::ifstream(file)); }

TEST(Experiment, WritesEveryFileOfARun) {
  const TemporaryFolder temporary;
  ExperimentOptions options;
  options.out = temporary.path() / "run";
  const auto experiment = run_experiment(short_walk(), options, keep_going);
  ASSERT_TRUE(experiment) << experiment.error().message;
  for (const char* file :
       {"scores.json", "scores.csv", "config.yaml", "truth.tum", "waypoint_times.csv", "aims.tum",
        "leg.tum", "aims.diagnostics.csv", "trajectories.png", "aims-map-top.png",
        "aims-map-side.png", "robot_start.png", "degeneracy.png"}) {
    EXPECT_TRUE(fs::exists(options.out / file)) << file;
  }
  EXPECT_TRUE(read_tum(options.out / "aims.tum"));
  const Json scores = read_json(options.out / "scores.json");
  EXPECT_EQ(scores["schema"], kScoresSchema);
  EXPECT_EQ(scores["scenario"], "short_walk");
  for (const char* key : {"m_list_percent", "m_list_signed_percent", "m_end_m", "m_end_xy_m",
                          "m_end_z_m", "ate_m", "max_error_m", "success", "time_per_scan_ms"}) {
    EXPECT_TRUE(scores["estimators"]["aims"].contains(key)) << key;
  }
}

TEST(Experiment, TheWrittenConfigurationReproducesTheRun) {
  const TemporaryFolder temporary;
  ExperimentOptions options;
  options.pictures = false;
  options.seeds = {5};
  options.out = temporary.path() / "first";
  ASSERT_TRUE(run_experiment(short_walk(), options, keep_going));
  const auto again = load_scenario(options.out / "config.yaml", {});
  ASSERT_TRUE(again) << again.error().message;
  options.seeds = {static_cast<std::uint64_t>(again->seed)};
  const fs::path first = options.out;
  options.out = temporary.path() / "second";
  ASSERT_TRUE(run_experiment(*again, options, keep_going));
  for (const char* file : {"aims.tum", "leg.tum", "truth.tum", "config.yaml"}) {
    std::ifstream a(first / file);
    std::ifstream b(options.out / file);
    EXPECT_TRUE(
        std::equal(std::istreambuf_iterator<char>(a), {}, std::istreambuf_iterator<char>(b), {}))
        << file;
  }
}

/// The text of a file that a run wrote, without what a clock decided.
std::string timeless(const fs::path& file) {
  std::ifstream stream(file);
  if (file.filename() == "scores.json") {
    Json json = Json::parse(stream);
    for (const char* key : {"wall_s", "realtime_factor", "times_s"}) json.erase(key);
    for (auto& [name, scores] : json["estimators"].items()) scores.erase("time_per_scan_ms");
    return json.dump();
  }
  const bool times_last = file.string().ends_with(".diagnostics.csv");
  std::string text;
  for (std::string line; std::getline(stream, line);) {
    if (line.find("time_per_scan_ms") != std::string::npos) continue;
    text += (times_last ? line.substr(0, line.rfind(',')) : line) + "\n";
  }
  return text;
}

TEST(Experiment, TwiceGivesTheSameBytesInEveryFileOnOneThreadAndOnTwo) {
  const TemporaryFolder temporary;
  ExperimentOptions options;
  options.pictures = false;
  options.seeds = {4};
  for (const int jobs : {1, 2}) {
    options.jobs = jobs;
    options.out = temporary.path() / std::to_string(jobs);
    ASSERT_TRUE(run_experiment(short_walk(), options, keep_going));
  }
  std::size_t files = 0;
  for (const auto& entry : fs::directory_iterator(temporary.path() / "1")) {
    const fs::path other = temporary.path() / "2" / entry.path().filename();
    EXPECT_TRUE(timeless(entry.path()) == timeless(other)) << entry.path().filename();
    ++files;
  }
  EXPECT_GE(files, 9U);
}

TEST(Experiment, SeveralSeedsGetAFolderEachAndASummary) {
  const TemporaryFolder temporary;
  ExperimentOptions options;
  options.pictures = false;
  options.seeds = {1, 2};
  options.out = temporary.path() / "runs";
  ASSERT_TRUE(run_experiment(short_walk(), options, keep_going));
  EXPECT_TRUE(fs::exists(options.out / "seed-1" / "scores.json"));
  EXPECT_TRUE(fs::exists(options.out / "seed-2" / "scores.json"));
  const Json summary = read_json(options.out / "summary.json");
  EXPECT_EQ(summary["estimators"]["aims"]["m_end_m"]["count"], 2);
  EXPECT_TRUE(fs::exists(options.out / "summary.md"));
}

TEST(Experiment, AnInterruptedRunLeavesReadableResults) {
  const TemporaryFolder temporary;
  ExperimentOptions options;
  options.pictures = false;
  options.out = temporary.path() / "run";
  const auto experiment = run_experiment(
      short_walk(), options,
      [](std::uint64_t, const Progress& progress) { return progress.simulated_s < 4.0; });
  ASSERT_TRUE(experiment);
  EXPECT_FALSE(experiment->complete);
  EXPECT_EQ(read_json(options.out / "scores.json")["complete"], false);
  EXPECT_TRUE(read_tum(options.out / "aims.tum"));
}

TEST(Experiment, AScenarioThatCannotRunWritesNothing) {
  const TemporaryFolder temporary;
  Scenario scenario = short_walk();
  scenario.simulation.route.points[1].x = 0.0;
  ExperimentOptions options;
  options.out = temporary.path() / "run";
  EXPECT_FALSE(run_experiment(scenario, options, keep_going));
  EXPECT_TRUE(fs::is_empty(temporary.path()));
}

}  // namespace
}  // namespace aims
