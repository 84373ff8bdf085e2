// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/tuning/analysis.hpp"
#include "bench/tuning/sweep_summary.hpp"
#include "bench/tuning/tune_plan.hpp"
#include "estimator/degeneracy/degeneracy.hpp"
#include "render/page/pages.hpp"
#include "tests/render/page/decoded_page.hpp"
#include "tests/render/page/written_run.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;
using testing::decoded;
using testing::DecodedPage;
using testing::put;

constexpr const char* kEta = "degeneracy.eta";
constexpr const char* kKappa = "degeneracy.kappa";

/// A unit's file; without values the untuned estimator.
Json unit(const std::string& scenario, int seed, const std::vector<double>& values, double ate) {
  Json settings = Json::object();
  if (!values.empty()) {
    settings = {{kEta, fmt::format("{}", values[0])}, {kKappa, fmt::format("{}", values[1])}};
  }
  return {{"schema", kJobSchema},
          {"scenario", scenario},
          {"family", ""},
          {"seed", seed},
          {"estimator", "aims"},
          {"settings", settings},
          {"outcome", "done"},
          {"message", ""},
          {"wall_s", 1.0},
          {"scores", {{"ate_yaw_m", ate}, {"success", true}, {"drift_m", {{"end", 2.0 * ate}}}}}};
}

/// Files and list of units of a folder, by the order in which they are added.
class Units {
 public:
  explicit Units(fs::path folder) : folder_(std::move(folder)) {
    fs::create_directories(folder_ / "jobs");
  }

  void add(const Json& unit) {
    list(unit);
    put(folder_ / "jobs" / (id_ + ".json"), unit.dump());
  }

  /// One that is not done yet.
  void list(const Json& unit) {
    id_ = fmt::format("{:04}", ++count_);
    list_ += fmt::format("{},\"{}\",{},aims,aims\n", id_, unit["scenario"].get<std::string>(),
                         unit["seed"].get<int>());
  }

  void write_list() const {
    put(folder_ / "jobs.csv", "id,scenario,seed,label,estimator\n" + list_);
  }
  const fs::path& folder() const { return folder_; }

 private:
  fs::path folder_;
  std::string id_;
  std::string list_;
  int count_ = 0;
};

constexpr const char* kRanges =
    "params: [\"degeneracy.eta=0:6:4\", \"degeneracy.kappa=log(1,100,3)\"]\n";

double ate_of(double eta, double kappa, int seed) {
  return 0.1 * seed * (1.0 + std::abs(eta - 4.0) + 0.1 * std::log10(kappa));
}

/// A grid of 4 by 3 on two seeds of "walk", best at (4, 1).
void write_grid(Units& units, bool untuned) {
  put(units.folder() / "plan.yaml", std::string("# aims sweep\n") + kRanges);
  for (const int seed : {1, 2}) {
    if (untuned) units.add(unit("walk", seed, {}, ate_of(3.0, 12.6, seed)));
    for (const double eta : {0.0, 2.0, 4.0, 6.0}) {
      for (const double kappa : {1.0, 10.0, 100.0}) {
        units.add(unit("walk", seed, {eta, kappa}, ate_of(eta, kappa, seed)));
      }
    }
  }
  units.write_list();
}

DecodedPage page_of(const fs::path& folder) {
  const auto page = tuning_page(folder, {});
  if (!page) throw std::runtime_error(page.error().message);
  return decoded(payload_text(*page));
}

std::string message_of(const fs::path& folder) {
  const auto page = tuning_page(folder, {});
  return page ? "" : page.error().message;
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::size_t column_of(const DecodedPage& page, const std::string& score) {
  const auto& scores = page.json["scores"];
  return static_cast<std::size_t>(std::find(scores.begin(), scores.end(), score) - scores.begin());
}

TEST(TuningPage, EveryUnitIsARowWithItsValuesAndScores) {
  const TemporaryFolder folder;
  Units units(folder.path());
  write_grid(units, true);
  const DecodedPage page = page_of(folder.path());
  EXPECT_EQ(page.json["source"], "sweep");
  EXPECT_EQ(page.json["jobs"]["done"], 26);
  const auto& own = page.json["estimators"][0];
  const auto point = page.f32(own["rows"]["point"]);
  const auto walk = page.f32(own["rows"]["sequence"]);
  const auto scores = page.f32(own["rows"]["scores"]);
  const auto values = page.f32(own["points"]["values"]);
  const std::size_t width = page.json["scores"].size();
  const std::size_t ate = column_of(page, "ate_yaw_m");
  const std::size_t end = column_of(page, "drift_m.end");
  ASSERT_EQ(point.size(), 26U);
  ASSERT_EQ(scores.size(), 26U * width);
  for (std::size_t row = 0; row < 26; ++row) {
    const auto at = 2 * static_cast<std::size_t>(point[row]);
    const int seed = page.json["sequences"][static_cast<std::size_t>(walk[row])]["seed"];
    EXPECT_NEAR(scores[row * width + ate], ate_of(values[at], values[at + 1], seed), 1e-6) << row;
    EXPECT_NEAR(scores[row * width + end], 2.0 * scores[row * width + ate], 1e-6);
  }
  EXPECT_EQ(own["parameters"][0]["default"], DegeneracyConfig{}.eta);
  EXPECT_EQ(own["parameters"][1]["log"], true);
}

TEST(TuningPage, AParameterOfTheSimulationHasItsUnitAndItsOwnDefault) {
  const TemporaryFolder folder;
  Units units(folder.path());
  put(units.folder() / "plan.yaml", "# aims sweep\nparams: [\"lidar.range_sigma=0.01:0.03:3\"]\n");
  for (const char* sigma : {"0.01", "0.02", "0.03"}) {
    Json walked = unit("walk", 1, {}, 0.1);
    walked["settings"] = {{"lidar.range_sigma", sigma}};
    walked["defaults"] = {{"lidar.range_sigma", "0.015"}};
    units.add(walked);
  }
  units.write_list();
  const DecodedPage page = page_of(folder.path());
  const auto& parameter = page.json["estimators"][0]["parameters"][0];
  EXPECT_EQ(parameter["unit"], "m");
  EXPECT_EQ(parameter["default"], 0.015);
  EXPECT_NE(parameter["meaning"], "");
}

TEST(TuningPage, TheAnalysisIsThatOfTheMergedSweep) {
  const TemporaryFolder folder;
  Units units(folder.path());
  write_grid(units, true);
  const DecodedPage page = page_of(folder.path());
  const auto responses = sweep_responses(*merge_sweeps(std::array{folder.path()}), "ate_yaw_m");
  ASSERT_TRUE(responses);
  const Objective objective;
  const auto best = best_point(responses->front().table, objective);
  ASSERT_TRUE(best);
  const auto& analysis = page.json["estimators"][0]["analyses"][0];
  EXPECT_EQ(analysis["score"], "ate_yaw_m");
  EXPECT_EQ(analysis["objective"], text_of(objective));
  EXPECT_EQ(analysis["best"]["values"], (std::vector<double>{4.0, 1.0}));
  EXPECT_EQ(analysis["best"]["text"].get<std::string>().find("degeneracy.eta 4 instead of "), 0U)
      << analysis["best"]["text"];
  EXPECT_EQ(analysis["best"]["objective"], best->objective);
  EXPECT_EQ(analysis["best"]["gain"], *best->gain);
  EXPECT_EQ(analysis["best"]["between"][0][0], *best->between[0].low);
  const auto& sensitivity = analysis["sensitivity"];
  EXPECT_GT(sensitivity["total"][0].get<double>(), sensitivity["total"][1].get<double>());
  const auto& curve = analysis["curves"][0];
  EXPECT_TRUE(curve["fit"].is_null());
  EXPECT_EQ(curve["held"], "degeneracy.kappa = 10 (default 12.6)");
  EXPECT_EQ(page.f32(curve["measured"]["x"]), (std::vector<float>{0.0F, 2.0F, 4.0F, 6.0F}));
  ASSERT_EQ(analysis["maps"].size(), 1U);
  EXPECT_EQ(page.f32(analysis["maps"][0]["measured"]["value"]).size(), 12U);
}

TEST(TuningPage, OfShardsInSeveralFoldersIsThatOfTheWhole) {
  const TemporaryFolder folder;
  Units units(folder.path() / "whole");
  write_grid(units, true);
  const std::vector<fs::path> shards = {folder.path() / "first", folder.path() / "second"};
  for (const fs::path& shard : shards) fs::copy(units.folder(), shard, fs::copy_options::recursive);
  std::size_t count = 0;
  for (const auto& entry : fs::directory_iterator(units.folder() / "jobs")) {
    fs::remove(shards[count++ % 2] / "jobs" / entry.path().filename());
  }
  const auto merged = merge_sweeps(shards);
  ASSERT_TRUE(merged) << merged.error().message;
  const auto page = tuning_page(merged_source(*merged, Objective()), folder.path());
  ASSERT_TRUE(page) << page.error().message;
  EXPECT_EQ(payload_text(*page), payload_text(*tuning_page(units.folder(), {})));
}

TEST(TuningPage, ACurveOfOneScenarioHasItsNameAndNotThatOfItsFamily) {
  const TemporaryFolder folder;
  Units units(folder.path());
  put(units.folder() / "plan.yaml", "# aims sweep\nparams: [\"degeneracy.eta=0:6:2\"]\n");
  for (const char* scenario : {"severity_6", "walk", "stairs"}) {
    for (const double eta : {0.0, 6.0}) {
      Json walked = unit(scenario, 1, {}, ate_of(eta, 1.0, 1));
      walked["settings"] = {{kEta, fmt::format("{}", eta)}};
      walked["family"] = std::string(scenario) == "severity_6" ? "severity" : "others";
      units.add(walked);
    }
  }
  units.write_list();
  std::vector<std::string> names;
  const DecodedPage page = page_of(folder.path());
  for (const auto& curve : page.json["estimators"][0]["analyses"][0]["curves"]) {
    names.push_back(curve["family"]);
  }
  EXPECT_EQ(names, (std::vector<std::string>{"", "severity_6", "others"}));
}

TEST(TuningPage, WithoutUntunedRunsThereIsNoGain) {
  const TemporaryFolder folder;
  Units units(folder.path());
  write_grid(units, false);
  const DecodedPage page = page_of(folder.path());
  const auto& analysis = page.json["estimators"][0]["analyses"][0];
  EXPECT_EQ(analysis["relative"], false);
  EXPECT_TRUE(analysis["best"]["gain"].is_null());
}

TEST(TuningPage, ASweepUnderWayIsAPageOfWhatIsThere) {
  const TemporaryFolder folder;
  Units units(folder.path());
  put(folder.path() / "plan.yaml", kRanges);
  units.write_list();
  EXPECT_TRUE(page_of(folder.path()).json["estimators"].empty());
  units.add(unit("walk", 1, {0.0, 1.0}, 0.3));
  units.add(unit("walk", 1, {2.0, 1.0}, 0.2));
  units.add(unit("walk", 2, {0.0, 1.0}, 0.4));
  units.list(unit("walk", 2, {2.0, 1.0}, 0.0));
  units.write_list();
  const DecodedPage page = page_of(folder.path());
  EXPECT_EQ(page.json["jobs"]["missing"], 1);
  const auto& own = page.json["estimators"][0];
  EXPECT_EQ(page.f32(own["rows"]["point"]).size(), 3U);
  const auto& analysis = own["analyses"][0];
  EXPECT_EQ(analysis["points"], 1);
  EXPECT_EQ(analysis["incomplete"], 1);
  EXPECT_TRUE(analysis["sensitivity"].is_null());
  EXPECT_TRUE(analysis["held_out"].is_null());
  EXPECT_FALSE(analysis["why_no_sensitivity"].get<std::string>().empty());
}

TEST(TuningPage, UnitsThatFailedAreLostRowsWithoutScores) {
  const TemporaryFolder folder;
  Units units(folder.path());
  put(folder.path() / "plan.yaml", kRanges);
  Json failed = unit("walk", 1, {0.0, 1.0}, 0.0);
  failed["outcome"] = "crashed";
  failed.erase("scores");
  units.add(failed);
  Json lost = unit("walk", 1, {2.0, 1.0}, 0.3);
  lost["scores"]["success"] = false;
  units.add(lost);
  put(folder.path() / "jobs/0003.json", "{\"schema\": \"aims.un");
  units.write_list();
  const DecodedPage page = page_of(folder.path());
  const auto& rows = page.json["estimators"][0]["rows"];
  EXPECT_EQ(page.array<std::uint8_t>(rows["diverged"]), (std::vector<std::uint8_t>{1, 1}));
  const auto scores = page.f32(rows["scores"]);
  const std::size_t ate = column_of(page, "ate_yaw_m");
  EXPECT_TRUE(std::isnan(scores[ate]));
  EXPECT_NEAR(scores[page.json["scores"].size() + ate], 0.3, 1e-6);
}

TEST(TuningPage, TheBestPointIsTheOneOfTheLeastObjectiveOfAll) {
  const TemporaryFolder folder;
  Units units(folder.path());
  write_grid(units, true);
  const DecodedPage page = page_of(folder.path());
  const auto& own = page.json["estimators"][0];
  const auto& analysis = own["analyses"][0];
  const auto objectives = page.f32(analysis["objectives"]);
  ASSERT_EQ(objectives.size(), 13U);
  const auto least = std::min_element(objectives.begin(), objectives.end());
  EXPECT_NEAR(*least, analysis["best"]["objective"].get<double>(), 1e-6);
  const auto values = page.f32(own["points"]["values"]);
  const auto at = 2 * static_cast<std::size_t>(least - objectives.begin());
  EXPECT_EQ(analysis["best"]["values"], (std::vector<double>{values[at], values[at + 1]}));
  EXPECT_NEAR(objectives[0], 1.0, 1e-6) << "of the defaults over themselves";
}

void write_tune_plan(const fs::path& folder) {
  put(folder / "tune.yaml",
      "params: [\"degeneracy.eta=0:6\", \"degeneracy.kappa=log(1,100)\"]\n"
      "scenarios: [walk]\nseeds: 1-2\nheld_out: {scenarios: [other], seeds: 7}\n"
      "objectives:\n  - {score: m_end_m, statistic: mean}\n");
}

TEST(TuningPage, ATuningKeepsWhatWasHeldOutApart) {
  const TemporaryFolder folder;
  Units units(folder.path());
  write_tune_plan(folder.path());
  for (const int seed : {1, 2}) {
    units.add(unit("walk", seed, {}, 0.3));
    units.add(unit("walk", seed, {1.0, 10.0}, 0.2));
  }
  units.add(unit("walk", 7, {}, 0.3));
  units.add(unit("other", 7, {1.0, 10.0}, 0.25));
  put(folder.path() / "jobs/broken.json", "{");
  const DecodedPage page = page_of(folder.path());
  EXPECT_EQ(page.json["source"], "tune");
  EXPECT_EQ(page.json["jobs"]["done"], 4);
  EXPECT_EQ(page.json["held_out_jobs"]["done"], 2);
  EXPECT_EQ(page.json["notes"].size(), 1U);
  const auto& own = page.json["estimators"][0];
  EXPECT_TRUE(own["points"]["generation"].is_null());
  EXPECT_EQ(own["analyses"][0]["score"], "m_end_m");
  EXPECT_EQ(own["analyses"][0]["points"], 2);  // the untuned values are one
  int held = 0;
  for (const auto each : page.array<std::uint8_t>(own["rows"]["held_out"])) held += each;
  EXPECT_EQ(held, 2);
}

TEST(TuningPage, JobsOfAnEarlierPlanInTheFolderDoNotCount) {
  const TemporaryFolder folder;
  Units units(folder.path());
  write_tune_plan(folder.path());
  Json failed = unit("walk", 1, {}, 0.0);
  failed["outcome"] = "failed";
  failed.erase("scores");
  units.add(failed);  // as of a plan whose scene could not be built
  for (const int seed : {1, 2}) {
    units.add(unit("walk", seed, {}, 0.3));
    units.add(unit("walk", seed, {1.0, 10.0}, 0.2));
  }
  ASSERT_TRUE(write_tune_jobs(folder.path(), {"0002", "0003", "0004", "0005"}));
  const DecodedPage page = page_of(folder.path());
  EXPECT_EQ(page.json["jobs"]["failed"], 0);
  EXPECT_EQ(page.json["jobs"]["done"], 4);
  EXPECT_TRUE(contains(page.json["notes"][0], "1 jobs of an earlier plan"));
}

TEST(TuningPage, ATuningLeadsWithWhatHeldOutSequencesSay) {
  const TemporaryFolder folder;
  Units units(folder.path());
  put(folder.path() / "tune.yaml",
      "params: [\"degeneracy.eta=0:6\", \"degeneracy.kappa=log(1,100)\"]\n"
      "scenarios: [walk]\nseeds: 1\nheld_out: {seeds: 11-18}\nobjectives:\n  - {score: "
      "ate_yaw_m}\n");
  units.add(unit("walk", 1, {}, 0.3));
  units.add(unit("walk", 1, {1.0, 10.0}, 0.2));
  for (int seed = 11; seed <= 18; ++seed) {
    units.add(unit("walk", seed, {}, 0.3));
    units.add(unit("walk", seed, {1.0, 10.0}, 0.33 + 0.001 * seed));
  }
  const DecodedPage page = page_of(folder.path());
  const auto& held = page.json["estimators"][0]["analyses"][0]["held_out"];
  EXPECT_EQ(held["verdict"], "do not use");
  EXPECT_EQ(held["sequences"], 8);
  EXPECT_LT(held["gain"].get<double>(), -0.1);
  EXPECT_TRUE(contains(held["text"], "worse on 8 held-out sequences"));
}

TEST(TuningPage, AFinishedTuningTellsEachPointsGeneration) {
  const TemporaryFolder folder;
  Units units(folder.path());
  write_tune_plan(folder.path());
  units.add(unit("walk", 1, {1.0, 10.0}, 0.2));
  units.add(unit("walk", 1, {2.0, 20.0}, 0.2));
  put(folder.path() / "tune.csv",
      "point,generation,degeneracy.eta,degeneracy.kappa,objective.0\n0,0,2,20,1\n1,3,1,10,0.5\n");
  const DecodedPage page = page_of(folder.path());
  EXPECT_EQ(page.f32(page.json["estimators"][0]["points"]["generation"]),
            (std::vector<float>{0.0F, 3.0F}))
      << "points are numbered as in tune.csv";
}

TEST(TuningPage, HostileScenariosArriveAsTheyAre) {
  const TemporaryFolder folder;
  Units units(folder.path());
  put(folder.path() / "plan.yaml", kRanges);
  const std::string name = "</script><script>alert(1)</script>";
  units.add(unit(name, 1, {0.0, 1.0}, 0.3));
  units.write_list();
  EXPECT_EQ(page_of(folder.path()).json["sequences"][0]["scenario"], name);
}

TEST(TuningPage, AFolderOfNeitherOrWithoutRangesSaysSo) {
  const TemporaryFolder folder;
  EXPECT_FALSE(holds_tuning(folder.path()));
  EXPECT_TRUE(contains(message_of(folder.path()), "plan.yaml"));
  put(folder.path() / "tune.yaml", "scenarios: [walk]\n");
  EXPECT_TRUE(holds_tuning(folder.path()));
  EXPECT_TRUE(contains(message_of(folder.path()), "varies nothing"));
  put(folder.path() / "tune.yaml", "scenarioss: [walk]\n");
  EXPECT_TRUE(contains(message_of(folder.path()), "scenarios"));
}

}  // namespace
}  // namespace aims
