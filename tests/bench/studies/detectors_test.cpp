// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "bench/studies/detectors.hpp"
#include "core/files/atomic_file.hpp"
#include "core/random.hpp"
#include "tests/bench/studies/short_walk.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

std::size_t index_of(const std::string& name) {
  const auto& indices = degeneracy_indices();
  for (std::size_t i = 0; i < indices.size(); ++i) {
    if (indices[i].name == name) return i;
  }
  ADD_FAILURE() << name;
  return 0;
}

const DetectorScore& score_of(const std::vector<DetectorScore>& scores, const std::string& index,
                              const std::string& level, const std::string& scenario = "") {
  for (const DetectorScore& score : scores) {
    if (score.index == index && score.level == level && score.scenario == scenario) return score;
  }
  ADD_FAILURE() << index << " " << level;
  return scores.front();
}

/// Truth that falls and rises, with every index a function of it.
DetectorRun run_with(const std::string& scenario, std::uint64_t seed, double lowest) {
  DetectorRun run;
  run.scenario = scenario;
  run.seed = seed;
  for (int i = 0; i < 200; ++i) {
    DetectorScan scan;
    scan.stamp = i * 100 * kMillisecond;
    const bool low = i >= 60 && i < 140;
    scan.equivalent_returns = low ? lowest : 5000.0;
    scan.values.assign(degeneracy_indices().size(), 0.0);
    scan.values[index_of("D")] = low ? 1.0 : 0.0;
    scan.values[index_of("C_IL")] = low ? 0.0 : 1.0;
    scan.values[index_of("smallest_eigenvalue")] = scan.equivalent_returns;
    run.scans.push_back(scan);
  }
  return run;
}

TEST(Detectors, APerfectIndexHasAucOneAReversedOneZeroAConstantOneHalf) {
  const std::vector<DetectorRun> runs = {run_with("x", 1, 1.0), run_with("x", 2, 1.0)};
  const auto scores = score_detectors(runs);
  EXPECT_EQ(score_of(scores, "D", "n10").auc, 1.0);
  EXPECT_EQ(score_of(scores, "C_IL", "n10").auc, 0.0);
  EXPECT_EQ(score_of(scores, "O_lidar", "n10").auc, 0.5);
  EXPECT_EQ(score_of(scores, "smallest_eigenvalue", "n10").auc, 1.0) << "low means degenerate";
  const DetectorScore& perfect = score_of(scores, "D", "n10");
  EXPECT_EQ(perfect.onsets, 2);
  EXPECT_EQ(perfect.missed, 0);
  EXPECT_EQ(perfect.median_delay_s, 0.0);
  EXPECT_EQ(perfect.detections, 1.0);
  EXPECT_EQ(perfect.auc_interval.low, 1.0);
  EXPECT_EQ(score_of(scores, "C_IL", "n10").missed, 2);
}

TEST(Detectors, StateTheThresholdInTheIndexOwnSign) {
  const std::vector<DetectorRun> runs = {run_with("x", 1, 1.0)};
  const auto scores = score_detectors(runs);
  EXPECT_EQ(score_of(scores, "smallest_eigenvalue", "n10").threshold, 1.0);
}

TEST(Detectors, SayWhichLevelsNeverChangeAndHaveNoNan) {
  const std::vector<DetectorRun> runs = {run_with("weak", 1, 50.0), run_with("strong", 1, 4000.0)};
  const auto scores = score_detectors(runs);
  EXPECT_FALSE(score_of(scores, "D", "n10").auc);
  EXPECT_EQ(score_of(scores, "D", "n100").auc, score_of(scores, "D", "n100").auc);
  EXPECT_TRUE(score_of(scores, "D", "n100").auc);
  const auto lines = undecided_levels(scores);
  ASSERT_FALSE(lines.empty());
  EXPECT_NE(lines[0].find("all runs, n10: none of 400 scans are degenerate"), std::string::npos)
      << lines[0];
  DetectorStudy study;
  study.runs = runs;
  study.scores = scores;
  study.warnings = lines;
  const TemporaryFolder folder;
  ASSERT_TRUE(write_detectors(study, folder.path()));
  for (const char* name : {"detectors.json", "detectors.csv", "detectors.md"}) {
    const std::string text = read_file(folder.path() / name).value();
    EXPECT_EQ(text.find("nan"), std::string::npos) << name;
    EXPECT_EQ(text.find("inf"), std::string::npos) << name;
  }
}

TEST(Detectors, IntervalsComeFromRunsAndNotFromScans) {
  RandomStream random(4, "test.detectors");
  std::vector<DetectorRun> runs;
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    runs.push_back(run_with("x", seed, 1.0));
    const double offset = random.normal();  // the same for all scans of a run
    for (DetectorScan& scan : runs.back().scans) {
      double& value = scan.values[index_of("D_smoothed")];
      value = (scan.equivalent_returns < 10.0 ? 0.3 : 0.0) + offset + 0.1 * random.normal();
    }
  }
  const auto scores = score_detectors(runs);
  const DetectorScore& score = score_of(scores, "D_smoothed", "n10");
  ASSERT_TRUE(score.auc_interval.low && score.auc_interval.high);
  EXPECT_GT(*score.auc_interval.high - *score.auc_interval.low, 0.05)
      << "1200 independent scans would give about 0.06 at AUC 0.6, six runs more";
  EXPECT_LE(*score.auc_interval.low, *score.auc);
  EXPECT_GE(*score.auc_interval.high, *score.auc);
}

TEST(DetectorRun, PairsByTheNearestStampAndLeavesOutWhatHasNoUpdateOrNoTruth) {
  std::vector<Localizability> truth(3);
  for (int i = 0; i < 3; ++i) {
    truth[i].stamp = (i + 1) * 100 * kMillisecond;
    truth[i].equivalent_returns = i;
  }
  Diagnostics diagnostics;
  diagnostics.series = {{"iterations", "-", ""}, {"D", "-", ""}};
  for (int i = 0; i < 4; ++i) {
    const Time stamp = (i + 1) * 100 * kMillisecond + 20 * kMillisecond;  // a clock offset
    diagnostics.scans.push_back({stamp, {}, {i == 0 ? 0.0 : 2.0, 0.1 * i}});
  }
  const DetectorRun run = detector_run(diagnostics, truth, 50 * kMillisecond);
  EXPECT_EQ(run.without_update, 1);
  EXPECT_EQ(run.without_truth, 1);
  ASSERT_EQ(run.scans.size(), 2U);
  EXPECT_EQ(run.scans[0].equivalent_returns, 1.0);
  EXPECT_DOUBLE_EQ(run.scans[0].values[index_of("D")], 0.1);
  EXPECT_TRUE(std::isnan(run.scans[0].values[index_of("C_IL")])) << "no such series: not zero";
}

TEST(DetectorRun, TakesEveryScanOfAnEstimatorWithoutIterationsAsAnUpdate) {
  std::vector<Localizability> truth(1);
  truth[0].stamp = kSecond;
  Diagnostics diagnostics;
  diagnostics.series = {{"condition_number", "-", ""}};
  diagnostics.scans.push_back({kSecond, {}, {7.0}});
  const DetectorRun run = detector_run(diagnostics, truth, kMillisecond);
  EXPECT_EQ(run.without_update, 0);
  ASSERT_EQ(run.scans.size(), 1U);
  EXPECT_EQ(run.scans[0].values[index_of("condition_number")], 7.0);
}

TEST(Detectors, LeaveOutAnIndexWhoseSeriesIsMissing) {
  std::vector<DetectorRun> runs = {run_with("x", 1, 1.0)};
  for (DetectorScan& scan : runs[0].scans) {
    scan.values[index_of("weak_weight")] = std::numeric_limits<double>::quiet_NaN();
  }
  const auto scores = score_detectors(runs);
  EXPECT_TRUE(std::ranges::none_of(
      scores, [](const DetectorScore& score) { return score.index == "weak_weight"; }));
  EXPECT_EQ(score_of(scores, "D", "n10").auc, 1.0);
  DetectorStudy study;
  study.runs = runs;
  study.scores = scores;
  const TemporaryFolder folder;
  ASSERT_TRUE(write_detectors(study, folder.path()));
  for (const char* name : {"detectors.json", "detectors.csv", "detectors.md"}) {
    EXPECT_EQ(read_file(folder.path() / name).value().find("weak_weight"), std::string::npos)
        << name;
  }
}

/// A few seconds in a corridor whose one end wall leaves the sensor's range on the way.
Scenario short_walk(const std::string& name, double range) {
  Scenario scenario;
  scenario.name = name;
  SimulationConfig& simulation = scenario.simulation;
  simulation.scene.corridor.length = 12.0;
  simulation.scene.corridor.doors.sides = WallSides::kNone;
  simulation.route.points = {{"a", 2.0, 0.0}, {"b", 4.0, 0.0}};
  simulation.route.stand_before = 2.5;
  simulation.lidar.columns = 240;
  simulation.lidar.range_max = range;
  return scenario;
}

/// The jobs of both ranges on two seeds, judged.
Result<DetectorStudy> study_of(const std::string& estimator, int processes, const fs::path& out) {
  std::vector<ScenarioFile> scenarios = {{"near.yaml", short_walk("near", 6.0)},
                                         {"far.yaml", short_walk("far", 20.0)}};
  for (ScenarioFile& each : scenarios) each.scenario->run = {estimator};
  SuiteOptions options = test::options_for(out, processes);
  options.jobs.outputs.trajectories = true;
  const auto suite = run_suite(std::move(scenarios), options, test::keep_going);
  if (!suite) return tl::unexpected(suite.error());
  return detector_study(*suite, out);
}

TEST(DetectorStudy, WritesTheSameBytesWithOneJobAndWithTwo) {
  const TemporaryFolder folder;
  const auto one = study_of("aims", 1, folder.path() / "one");
  const auto two = study_of("aims", 2, folder.path() / "two");
  ASSERT_TRUE(one && two) << (one ? two.error().message : one.error().message);
  ASSERT_EQ(one->runs.size(), 4U);
  EXPECT_EQ(one->runs[1].scenario, "near");
  EXPECT_EQ(one->runs[1].seed, 2U);
  ASSERT_TRUE(write_detectors(*one, folder.path() / "one"));
  ASSERT_TRUE(write_detectors(*two, folder.path() / "two"));
  for (const char* name : {"detectors.json", "detectors.csv", "detectors.md"}) {
    EXPECT_EQ(read_file(folder.path() / "one" / name).value(),
              read_file(folder.path() / "two" / name).value())
        << name;
  }
  EXPECT_TRUE(score_of(one->scores, "D", "n10").auc) << "the near sensor loses the end walls";
}

TEST(DetectorStudy, RefusesAnEstimatorWithoutIndices) {
  const TemporaryFolder folder;
  const auto study = study_of("leg", 1, folder.path() / "out");
  ASSERT_FALSE(study);
  EXPECT_NE(study.error().message.find("leg"), std::string::npos);
}

}  // namespace
}  // namespace aims
