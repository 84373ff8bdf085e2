// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "core/series_style.hpp"
#include "render/page/page.hpp"
#include "render/page/pages.hpp"
#include "tests/render/page/written_run.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

/// Folders seed-N of the same made-up run, whose scores have that seed.
void write_seeds(const fs::path& folder, const std::vector<int>& seeds) {
  for (const int seed : seeds) {
    const fs::path run = folder / ("seed-" + std::to_string(seed));
    testing::write_run(run, {.scans = 20, .map_points = 50});
    Json scores = Json::parse(testing::content(run / "scores.json"));
    scores["seed"] = seed;
    testing::put(run / "scores.json", scores.dump(2));
  }
}

TEST(SeedsPage, IsOneScenarioOverItsSeedsWithLinksToTheirPages) {
  const TemporaryFolder folder;
  write_seeds(folder.path(), {2, 3, 10});
  testing::put(folder.path() / "seed-3/page.html", "");
  auto page = seeds_page(folder.path(), {});
  ASSERT_TRUE(page) << page.error().message;
  EXPECT_EQ(page->title, "made_up, seeds 2, 3, 10");
  EXPECT_EQ(page->json["kind"], "suite");
  ASSERT_EQ(page->json["suite"]["scenarios"].size(), 1U);
  Json scenario = page->json["suite"]["scenarios"][0];
  EXPECT_EQ(scenario["seeds"], Json::parse("[2, 3, 10]"));
  EXPECT_EQ(scenario["estimators"]["exact"]["runs"], 3);
  ASSERT_EQ(page->json["runs"].size(), 3U);
  EXPECT_TRUE(page->json["runs"][0]["href"].is_null()) << "it has no page";
  EXPECT_EQ(page->json["runs"][1]["href"], "seed-3/page.html");
}

TEST(SeedsPage, IsWrittenAfterThePagesOfItsSeeds) {
  const TemporaryFolder folder;
  write_seeds(folder.path(), {1, 2});
  const auto written = write_pages(folder.path());
  if (!written && written.error().message.find("without the page") != std::string::npos) {
    GTEST_SKIP() << written.error().message;
  }
  ASSERT_TRUE(written) << written.error().message;
  ASSERT_EQ(written->pages.size(), 3U);
  EXPECT_EQ(written->pages.back(), folder.path() / "page.html");
  EXPECT_TRUE(fs::exists(folder.path() / "page.html"));
}

TEST(SeedsPage, SaysWhoFailedAndWhatWasSet) {
  const TemporaryFolder folder;
  write_seeds(folder.path(), {1, 2});
  const Json summary = Json::parse(
      R"({"complete": false, "settings": ["lidar.columns=90"], "failures": [{"scenario": "made_up",
          "seed": 2, "estimator": "mine", "message": "no"}], "estimators": {}})");
  testing::put(folder.path() / "summary.json", summary.dump());
  auto page = seeds_page(folder.path(), {});
  ASSERT_TRUE(page) << page.error().message;
  for (const char* key : {"complete", "settings", "failures"}) {
    EXPECT_EQ(page->json["suite"][key], summary[key]) << key;
  }
  testing::put(folder.path() / "summary.json", "{");
  page = seeds_page(folder.path(), {});
  ASSERT_TRUE(page) << page.error().message;
  EXPECT_EQ(page->json["notes"].size(), 1U) << page->json["notes"];
}

TEST(SeedsPage, CountsASeedOnWhichEveryEstimatorFailed) {
  const TemporaryFolder folder;
  write_seeds(folder.path(), {1, 2});
  const fs::path failed = folder.path() / "seed-1";
  fs::remove(failed / "truth.tum");
  Json scores = Json::parse(testing::content(failed / "scores.json"));
  scores["estimators"] = Json::object();
  scores["failures"] = {{{"estimator", "exact"}, {"message", "killed"}}};
  testing::put(failed / "scores.json", scores.dump(2));
  auto page = seeds_page(folder.path(), {});
  ASSERT_TRUE(page) << page.error().message;
  EXPECT_EQ(page->title, "made_up, seeds 1–2");
  const Json scenario = page->json["suite"]["scenarios"][0];
  EXPECT_EQ(scenario["estimators"]["exact"]["runs"], 2);
  EXPECT_EQ(seed_folders(folder.path()).size(), 1U) << "it has no page of its own";
}

TEST(SeedsPage, CarriesTheStylesOfAllPages) {
  const TemporaryFolder folder;
  write_seeds(folder.path(), {1, 2});
  auto page = seeds_page(folder.path(), {});
  ASSERT_TRUE(page) << page.error().message;
  ASSERT_EQ(page->json["palette"].size(), kSeriesStyles);
  const std::vector<std::string> names = {"exact", "ahead"};
  const auto styles = series_styles(names);
  EXPECT_EQ(page->json["styles"]["exact"], styles[0]);
  EXPECT_EQ(page->json["styles"]["ahead"], styles[1]);
  EXPECT_EQ(page->json["palette"][0]["light"], "#2a24de");
}

TEST(SeedsPage, WithoutSeedsThereIsNone) {
  const TemporaryFolder folder;
  EXPECT_TRUE(seed_folders(folder.path()).empty());
  EXPECT_FALSE(seeds_page(folder.path(), {}));
}

TEST(SeedsPage, SaysWhatWasSetOnce) {
  const TemporaryFolder folder;
  write_seeds(folder.path(), {1, 2});
  for (const char* seed : {"seed-1", "seed-2"}) {
    testing::put(folder.path() / seed / "config.yaml",
                 "description: \"A walk. With changed settings: lidar.columns=90.\"\n");
  }
  testing::put(folder.path() / "summary.json", R"({"settings": ["lidar.columns=90"]})");
  const auto page = seeds_page(folder.path(), {});
  ASSERT_TRUE(page) << page.error().message;
  EXPECT_EQ(page->json["description"], "A walk.");
  EXPECT_EQ(page->json["suite"]["settings"], Json::parse(R"(["lidar.columns=90"])"));
}

TEST(SeedsPage, NamesEstimatesThatLackAPart) {
  const TemporaryFolder folder;
  write_seeds(folder.path(), {1, 2});
  const fs::path file = folder.path() / "seed-2/scores.json";
  Json scores = Json::parse(testing::content(file));
  scores["estimators"]["exact"]["success"] = false;
  scores["estimators"]["exact"]["diverged_reason"] = "ends_early";
  scores["failures"] = {{{"estimator", "broken"}, {"message", "killed"}}};
  testing::put(file, scores.dump(2));
  const auto page = seeds_page(folder.path(), {});
  ASSERT_TRUE(page) << page.error().message;
  EXPECT_EQ(page->json["runs"][0]["partial"], Json::array());
  EXPECT_EQ(page->json["runs"][1]["partial"], Json::parse(R"(["exact", "broken"])"));
  const auto run = run_page(folder.path() / "seed-2");
  ASSERT_TRUE(run) << run.error().message;
  EXPECT_EQ(run->json["partial"], Json::parse(R"(["exact", "broken"])"));
}

}  // namespace
}  // namespace aims
