// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <fstream>
#include <map>

#include "bench/studies/written_runs.hpp"
#include "core/files/tum.hpp"
#include "render/results/pictures.hpp"
#include "tests/bench/studies/short_walk.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;
using test::keep_going;
using test::options_for;
using test::short_walk;

Json read_json(const fs::path& file) { return Json::parse(std::ifstream(file)); }

/// Does what `aims run` does, but for pictures and page. An error fails the test with its message.
Result<Suite> run(const Scenario& scenario, const std::vector<std::uint64_t>& seeds,
                  const fs::path& out, int processes = 1) {
  SuiteOptions options = options_for(out, processes);
  options.seeds = seeds;
  options.jobs.outputs.trajectories = true;
  auto suite = run_suite({{"short.yaml", scenario}}, options, keep_going);
  EXPECT_TRUE(suite) << suite.error().message;
  if (!suite) return suite;
  if (auto written = write_runs(*suite, out); !written) return tl::unexpected(written.error());
  return suite;
}

TEST(RunFolder, HoldsEveryFileAndPicture) {
  const TemporaryFolder temporary;
  const fs::path out = temporary.path() / "run";
  const auto suite = run(short_walk(), {1}, out);
  ASSERT_TRUE(suite) << suite.error().message;
  ASSERT_EQ(run_folders(*suite, out), std::vector{out});
  const auto drawn = draw_run(out);
  ASSERT_TRUE(drawn) << drawn.error().message;
  for (const char* file :
       {"jobs.csv", "scores.json", "scores.csv", "config.yaml", "truth.tum", "waypoint_times.csv",
        "localizability.csv", "legs.csv", "aims.tum", "aims.map.ply", "leg.tum",
        "aims.diagnostics.csv", "trajectories.png", "aims-map-top.png", "aims-map-side.png",
        "robot_start.png", "degeneracy.png"}) {
    EXPECT_TRUE(fs::exists(out / file)) << file;
  }
  EXPECT_TRUE(read_tum(out / "aims.tum"));
  const Json scores = read_json(out / "scores.json");
  EXPECT_EQ(scores["schema"], kScoresSchema);
  EXPECT_EQ(scores["scenario"], "short_walk");
  EXPECT_FALSE(scores["robot"]["fell"]);
  for (const char* key :
       {"m_list_percent", "m_list_signed_percent", "m_end_m", "m_end_xy_m", "m_end_z_m", "ate_m",
        "max_error_m", "success", "time_per_scan_ms", "cpu_per_scan_ms"}) {
    EXPECT_TRUE(scores["estimators"]["aims"].contains(key)) << key;
  }
}

TEST(RunFolder, ThePicturesDoNotDependOnTheThreads) {
  const TemporaryFolder temporary;
  const fs::path out = temporary.path() / "run";
  ASSERT_TRUE(run(short_walk(), {1}, out));
  ASSERT_TRUE(draw_run(out, {}, 1));
  std::map<fs::path, std::string> drawn;
  for (const fs::path& picture : pictures_in(out)) drawn[picture] = read_file(picture).value();
  ASSERT_GE(drawn.size(), 7U);
  std::vector<fs::path> announced;
  ASSERT_TRUE(draw_run(
      out, [&](const fs::path& file) { announced.push_back(file); }, 2));
  for (const auto& [picture, bytes] : drawn) {
    EXPECT_TRUE(read_file(picture).value() == bytes) << picture;
  }
  EXPECT_EQ(announced.front(), out / "robot_start.png");
}

TEST(RunFolder, APictureThatCannotBeDrawnIsNamedOnAnyNumberOfThreads) {
  const TemporaryFolder temporary;
  const fs::path out = temporary.path() / "run";
  ASSERT_TRUE(run(short_walk(), {1}, out));
  fs::create_directories(out / "trajectories.png" / "in the way");
  for (const int threads : {1, 2}) {
    const auto drawn = draw_run(out, {}, threads);
    ASSERT_FALSE(drawn);
    EXPECT_NE(drawn.error().message.find("trajectories.png"), std::string::npos);
  }
}

TEST(RunFolder, ThePapersPicturesReadOnlyWhatTheyShow) {
  const TemporaryFolder temporary;
  const fs::path out = temporary.path() / "run";
  ASSERT_TRUE(run(short_walk(), {1}, out));
  ASSERT_TRUE(fs::exists(out / "aims.map.ply"));
  std::ofstream(out / "aims.diagnostics.csv") << "not read";
  ASSERT_TRUE(draw_systems(out, {"aims"}, temporary.path()));
  EXPECT_TRUE(fs::exists(temporary.path() / "short_walk-trajectories.png"));
  EXPECT_TRUE(fs::exists(temporary.path() / "short_walk-maps.png"));
  fs::remove(out / "aims.map.ply");
  std::ofstream(out / "aims.map.ply") << "not read either";
  EXPECT_TRUE(draw_systems(out, {"leg"}, temporary.path()));
  EXPECT_FALSE(draw_systems(out, {"aims"}, temporary.path()));
}

TEST(RunFolder, HoldsTheReoptimizedTrajectoryOfAnEstimatorThatHasOne) {
  const TemporaryFolder temporary;
  const fs::path out = temporary.path() / "run";
  const auto suite = run(short_walk(), {1}, out);
  ASSERT_TRUE(suite) << suite.error().message;
  const fs::path own = JobStore(out).outputs_of(suite->jobs[0].id);
  fs::copy_file(own / "estimate.tum", own / "estimate.optimized.tum");
  ASSERT_TRUE(write_runs(*suite, out));
  EXPECT_TRUE(read_tum(out / "aims.optimized.tum"));
  EXPECT_FALSE(fs::exists(out / "leg.optimized.tum"));
}

TEST(RunFolder, ItsConfigurationReproducesTheRun) {
  const TemporaryFolder temporary;
  const fs::path first = temporary.path() / "first";
  const fs::path second = temporary.path() / "second";
  ASSERT_TRUE(run(short_walk(), {5}, first));
  const auto again = load_scenario(first / "config.yaml", {});
  ASSERT_TRUE(again) << again.error().message;
  ASSERT_TRUE(run(*again, {static_cast<std::uint64_t>(again->seed)}, second));
  for (const char* file : {"aims.tum", "leg.tum", "truth.tum", "config.yaml"}) {
    std::ifstream a(first / file);
    std::ifstream b(second / file);
    EXPECT_TRUE(
        std::equal(std::istreambuf_iterator<char>(a), {}, std::istreambuf_iterator<char>(b), {}))
        << file;
  }
}

/// The text of a file of a run, without what a clock decided.
std::string timeless(const fs::path& file) {
  std::ifstream stream(file);
  if (file.filename() == "scores.json") {
    Json json = Json::parse(stream);
    json.erase("wall_s");
    for (auto& [name, scores] : json["estimators"].items()) {
      for (const char* times : {"time_per_scan_ms", "cpu_per_scan_ms"}) scores.erase(times);
    }
    return json.dump();
  }
  const bool times_last = file.string().ends_with(".diagnostics.csv");
  std::string text;
  for (std::string line; std::getline(stream, line);) {
    if (line.find("_per_scan_ms") != std::string::npos) continue;
    text += (times_last ? line.substr(0, line.rfind(',')) : line) + "\n";
  }
  return text;
}

TEST(RunFolder, HasTheSameBytesInEveryFileWithOneJobAndWithTwo) {
  const TemporaryFolder temporary;
  for (const int processes : {1, 2}) {
    ASSERT_TRUE(run(short_walk(), {4}, temporary.path() / std::to_string(processes), processes));
  }
  std::size_t files = 0;
  for (const auto& entry : fs::directory_iterator(temporary.path() / "1")) {
    if (!entry.is_regular_file()) continue;
    const fs::path other = temporary.path() / "2" / entry.path().filename();
    EXPECT_TRUE(timeless(entry.path()) == timeless(other)) << entry.path().filename();
    ++files;
  }
  EXPECT_GE(files, 9U);
}

TEST(RunFolder, SeveralSeedsGetAFolderEachAndASummary) {
  const TemporaryFolder temporary;
  const fs::path out = temporary.path() / "runs";
  ASSERT_TRUE(run(short_walk(), {1, 2}, out));
  EXPECT_TRUE(fs::exists(out / "seed-1" / "scores.json"));
  EXPECT_TRUE(fs::exists(out / "seed-2" / "aims.tum"));
  const Json summary = read_json(out / "summary.json");
  EXPECT_EQ(summary["estimators"]["aims"]["m_end_m"]["count"], 2);
  EXPECT_TRUE(fs::exists(out / "summary.md"));
}

TEST(RunFolder, TheSameRunAgainDoesNothingAndOtherEstimatorsReplaceTheirFiles) {
  const TemporaryFolder temporary;
  const fs::path out = temporary.path() / "run";
  ASSERT_TRUE(run(short_walk(), {1}, out));
  EXPECT_EQ(run(short_walk(), {1}, out)->run.done, 0U);
  Scenario other = short_walk();
  other.run = {"aims"};
  EXPECT_EQ(run(other, {1}, out)->run.done, 0U);
  EXPECT_TRUE(fs::exists(out / "aims.tum"));
  EXPECT_FALSE(fs::exists(out / "leg.tum"));
}

TEST(RunFolder, AScenarioThatCannotBeSimulatedIsAFailure) {
  const TemporaryFolder temporary;
  Scenario scenario = short_walk();
  scenario.simulation.route.points[1].x = 0.0;
  const auto suite = run(scenario, {1}, temporary.path() / "run");
  ASSERT_TRUE(suite) << suite.error().message;
  EXPECT_TRUE(suite->cases.front().runs.empty());
  ASSERT_EQ(suite->failures.size(), 1U);
  EXPECT_NE(suite->failures.front().message.find("could not be simulated"), std::string::npos);
}

}  // namespace
}  // namespace aims
