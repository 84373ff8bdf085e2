// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "render/page/map_cloud.hpp"
#include "render/page/page.hpp"
#include "render/page/page_template.hpp"
#include "render/page/pages.hpp"
#include "render/page/series.hpp"
#include "tests/render/page/decoded_page.hpp"
#include "tests/render/page/written_run.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

using testing::decoded;
using testing::DecodedPage;
using testing::kStep;

class RunPage : public ::testing::Test {
 protected:
  DecodedPage page_of(const testing::WrittenRun& run) {
    testing::write_run(folder_.path() / "run", run);
    return read();
  }

  /// The page of what lies in the folder now.
  DecodedPage read() {
    const auto page = run_page(folder_.path() / "run");
    EXPECT_TRUE(page) << page.error().message;
    return decoded(payload_text(*page));
  }

  TemporaryFolder folder_;
};

TEST_F(RunPage, HoldsTheScoresAndTheConfigurationAsTheFilesHaveThem) {
  const DecodedPage page = page_of({});
  EXPECT_EQ(page.json["schema"], "aims.page/2");
  EXPECT_EQ(page.json["kind"], "run");
  EXPECT_EQ(page.json["scores"],
            nlohmann::json::parse(testing::content(folder_.path() / "run" / "scores.json")));
  EXPECT_EQ(page.json["config_yaml"], testing::content(folder_.path() / "run" / "config.yaml"));
  EXPECT_EQ(page.json["command"], "aims run config.yaml --seed 7 --out again");
  EXPECT_EQ(page.json["scenario"]["name"], "made_up");
  EXPECT_EQ(page.json["notes"].size(), 0U) << page.json["notes"];
}

TEST_F(RunPage, NamesWhatDiffersFromTheDefaultsWithUnitAndDefault) {
  const DecodedPage page = page_of({});
  bool found = false;
  for (const auto& change : page.json["config_changes"]) {
    EXPECT_NE(change["value"], change["default"]) << change["key"];
    if (change["key"] != "lidar.range_max") continue;
    found = true;
    EXPECT_EQ(change["value"], "33");
    EXPECT_EQ(change["unit"], "m");
  }
  EXPECT_TRUE(found) << page.json["config_changes"];
  EXPECT_LT(page.json["config_changes"].size(), 5U) << page.json["config_changes"];
}

TEST_F(RunPage, LaysEstimatesOntoTheTruthAndSplitsTheirErrorAlongItsHeading) {
  const DecodedPage page = page_of({});
  const auto& exact = page.json["estimators"][0];
  const auto& ahead = page.json["estimators"][1];
  EXPECT_EQ(exact["name"], "exact");
  const auto p = page.f32(exact["series"]["p"]);
  EXPECT_FLOAT_EQ(p[0], 1.0F);
  EXPECT_FLOAT_EQ(p[1], 0.2F);
  EXPECT_FLOAT_EQ(p[2], 0.3F);
  const auto along = page.f32(ahead["series"]["error_longitudinal"]);
  const auto lateral = page.f32(ahead["series"]["error_lateral"]);
  ASSERT_EQ(along.size(), 50U);
  for (std::size_t i = 0; i < along.size(); ++i) {
    EXPECT_NEAR(along[i], 0.1 * kStep * static_cast<double>(i), 5e-6);
    EXPECT_NEAR(lateral[i], 0.0, 1e-6);
  }
}

TEST_F(RunPage, HasTheDiagnosticsAtTheStampsOfThePoses) {
  const DecodedPage page = page_of({.scans = 20});
  const auto& series = page.json["estimators"][0]["series"];
  const auto t = page.f32(series["t"]);
  ASSERT_EQ(t.size(), 20U);
  EXPECT_FLOAT_EQ(t[3], 0.4F);
  EXPECT_FLOAT_EQ(page.f32(series["innovation"])[3], 5e-3F);
  EXPECT_FLOAT_EQ(page.f32(series["sigma_vertical"])[3], 0.02F);
  EXPECT_EQ(page.f32(series["position_covariance"]).size(), 6U * 20U);
  for (const float D : page.f32(series["D"])) EXPECT_FALSE(std::isnan(D));
}

TEST_F(RunPage, BreaksTheSeriesWhereAnEstimateHasAGap) {
  testing::write_run(folder_.path() / "run", {});
  const auto file = folder_.path() / "run" / "exact.tum";
  std::istringstream lines(testing::content(file));
  std::string text;
  int pose = 0;
  for (std::string line; std::getline(lines, line);) {
    const bool of_pose = !line.empty() && line.front() != '#';
    const int at = of_pose ? pose++ : -1;
    if (at < 10 || at >= 40) text += line + "\n";
  }
  testing::put(file, text);
  const DecodedPage page = read();
  const auto& series = page.json["estimators"][0]["series"];
  const auto p = page.f32(series["p"]);
  ASSERT_EQ(p.size(), 3U * 21U) << "20 poses and a break";
  EXPECT_TRUE(std::isnan(p[30]));
  EXPECT_FALSE(std::isnan(p[27]) || std::isnan(p[33]));
  EXPECT_TRUE(std::isnan(page.f32(series["error_longitudinal"])[10]));
  EXPECT_EQ(page.f32(page.json["estimators"][1]["series"]["t"]).size(), 50U);
}

TEST_F(RunPage, TellsDegenerateStretchesFromTheScanBeforeToTheirLast) {
  const DecodedPage page = page_of({});
  const auto& degenerate = page.json["localizability"]["degenerate"];
  EXPECT_EQ(degenerate["n10"].size(), 0U);
  ASSERT_EQ(degenerate["n100"].size(), 1U);
  EXPECT_NEAR(degenerate["n100"][0][0].get<double>(), 1.0, 1e-9);
  EXPECT_NEAR(degenerate["n100"][0][1].get<double>(), 2.0, 1e-9);
  EXPECT_EQ(degenerate["n1000"].size(), 0U) << "the file has no such column";
}

TEST_F(RunPage, ThinsLongSeriesAndLargeMapsAndKeepsTheLastPose) {
  const DecodedPage page = page_of({.scans = 9001, .map_points = 100000});
  const auto& first = page.json["estimators"][0];
  const auto t = page.f32(first["series"]["t"]);
  EXPECT_LE(t.size(), kLongestSeries);
  EXPECT_GT(t.size(), kLongestSeries / 2);
  EXPECT_FLOAT_EQ(t.back(), 900.1F);
  EXPECT_EQ(page.f32(first["series"]["p"]).size(), 3 * t.size());
  const auto points = first["map"]["n"].get<std::size_t>();
  EXPECT_LE(points, kMostMapPoints);
  EXPECT_EQ(first["map"]["points"], 100000U);
  EXPECT_GT(points, kMostMapPoints / 3);
  EXPECT_EQ(first["map"]["p"]["n"], 3 * points);
  EXPECT_EQ(first["map"]["error"]["n"], points);
}

TEST_F(RunPage, HoldsTheScansWithWhatIsBelowTheCeilingFirst) {
  testing::write_run(folder_.path() / "run", {});  // at 1 s the body is at (1.45, 0.2, 0.3)
  testing::put(folder_.path() / "run" / "scans.csv",
               "stamp_s,returns,x,y,z,intensity\n"
               "1,900,2,0,2.4,1\n"
               "1,900,3,0.5,0.2,0.5\n"
               "2,800,1,0,0,0\n");
  const DecodedPage page = read();
  const auto& scans = page.json["scans"];
  EXPECT_EQ(page.f32(scans["t"]), (std::vector<float>{1.0F, 2.0F}));
  EXPECT_EQ(page.f32(scans["first"]), (std::vector<float>{0.0F, 2.0F}));
  EXPECT_EQ(page.f32(scans["returns"]), (std::vector<float>{900.0F, 800.0F}));
  EXPECT_EQ(page.f32(scans["below"]), (std::vector<float>{1.0F, 1.0F}));
  const auto p = page.f32(scans["p"]);
  const std::vector<float> expected = {3.0F, 0.5F, 0.2F, 2.0F, 0.0F, 2.4F, 1.0F, 0.0F, 0.0F};
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(p[i], expected[i], 0.0051F);
  EXPECT_EQ(page.array<std::uint8_t>(scans["intensity"]), (std::vector<std::uint8_t>{128, 255, 0}));
}

TEST_F(RunPage, WithoutASceneTheCeilingIsOverTheBody) {
  testing::write_run(folder_.path() / "run", {});
  std::filesystem::remove(folder_.path() / "run" / "config.yaml");
  testing::put(folder_.path() / "run" / "scans.csv",
               "stamp_s,returns,x,y,z,intensity\n1,900,2,0,1.9,1\n1,900,3,0.5,0.2,0.5\n"
               "1,900,1,0,1.6,0\n");
  for (const bool with_truth : {true, false}) {
    if (!with_truth) std::filesystem::remove(folder_.path() / "run" / "truth.tum");
    const DecodedPage page = read();
    EXPECT_EQ(page.f32(page.json["scans"]["below"]), (std::vector<float>{2.0F}));
  }
}

TEST_F(RunPage, CountsSecondsFromTheStartOfAnEpochsClock) {
  const DecodedPage page = page_of({.scans = 20, .start_s = 1.7e9});
  EXPECT_NEAR(page.json["t0_s"].get<double>(), 1.7e9 + 0.1, 1e-6) << "the truth's first pose";
  EXPECT_NEAR(page.f32(page.json["truth"]["t"])[0], 0.0, 1e-6);
  EXPECT_NEAR(page.f32(page.json["estimators"][0]["series"]["t"])[19], 1.9, 1e-6);
  EXPECT_FALSE(page.json["estimators"][0]["series"]["D"].is_null());
}

TEST_F(RunPage, IsTheSameBytesForTheSameFolderWhereverItLies) {
  testing::write_run(folder_.path() / "run", {});
  std::filesystem::copy(folder_.path() / "run", folder_.path() / "elsewhere");
  const auto one = run_page(folder_.path() / "run");
  const auto two = run_page(folder_.path() / "elsewhere");
  ASSERT_TRUE(one && two);
  EXPECT_EQ(payload_text(*one), payload_text(*two));
  EXPECT_EQ(one->title, two->title);
}

TEST_F(RunPage, OfThirteenSystemsAlongTheCorridorStaysUnderFiveMegabytes) {
  constexpr int kSystems = 13;
  testing::write_run(folder_.path() / "run",
                     {.scans = 2400, .map_points = 30000, .noisy = kSystems - 2});
  testing::put(folder_.path() / "run" / "scans.csv", testing::noisy_scans());
  const auto page = run_page(folder_.path() / "run");
  ASSERT_TRUE(page) << page.error().message;
  ASSERT_EQ(page->json["estimators"].size(), std::size_t{kSystems});
  const std::size_t data = payload_text(*page).size();
  const auto pictures = 4U * 100U * 1024U * 4U / 3U;
  EXPECT_LT(data + pictures + page_template(PageKind::kRun).size(), 5U * 1000U * 1000U) << data;
}

TEST_F(RunPage, IsWrittenIntoTheFolderUnlessBuiltWithout) {
  testing::write_run(folder_.path() / "run", {});
  const auto written = write_pages(folder_.path() / "run");
  if (page_template(PageKind::kRun).empty()) {
    ASSERT_FALSE(written);
    EXPECT_NE(written.error().message.find("AIMS_PAGE"), std::string::npos);
    GTEST_SKIP() << "built without the page: npm was not found or not reachable";
  }
  ASSERT_TRUE(written) << written.error().message;
  ASSERT_EQ(written->pages.size(), 1U);
  const DecodedPage page = testing::decoded_html(testing::content(written->pages[0]));
  EXPECT_EQ(page.json["scores"]["estimators"]["exact"]["ate_m"], 0.125);
}

}  // namespace
}  // namespace aims
