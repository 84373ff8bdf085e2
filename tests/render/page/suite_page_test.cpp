// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "bench/jobs/job.hpp"
#include "bench/jobs/stored_results.hpp"
#include "bench/scoring/json_text.hpp"
#include "bench/studies/comparison.hpp"
#include "bench/studies/suite_summary.hpp"
#include "core/files/csv.hpp"
#include "render/page/links.hpp"
#include "render/page/pages.hpp"
#include "tests/render/page/decoded_page.hpp"
#include "tests/render/page/written_run.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;
using testing::decoded;
using testing::put;

constexpr const char* kHostile = "</script><script>alert(1)</script>\"&\\ \xc3\xa9";

Json record(std::uint64_t seed, double ate, bool success = true) {
  return {{"schema", kScoresSchema},
          {"seed", seed},
          {"complete", true},
          {"estimators",
           {{"aims",
             {{"success", success},
              {"diverged_at_s", success ? Json() : Json(12.5)},
              {"diverged_reason", success ? "" : "error_limit"},
              {"ate_m", ate},
              {"m_end_m", nullptr},
              {"m_list_percent", {{"all", 10.0 * ate}}}}}}}};
}

Json scenario(const std::string& name, const std::vector<std::uint64_t>& seeds) {
  return {{"name", name},
          {"seeds", seeds},
          {"estimators", {{"aims", {{"runs", seeds.size()}, {"scores", Json::object()}}}}}};
}

void write_suite_json(const fs::path& folder, const Json& scenarios) {
  fs::create_directories(folder);
  const Json suite = {{"schema", kSuiteSchema}, {"version", "1.2.3"}, {"scenarios", scenarios}};
  put(folder / "suite.json", suite.dump(2));
}

/// File of the job of `aims` on that seed.
fs::path job_file(const fs::path& folder, std::uint64_t seed) {
  return folder / "jobs" / fmt::format("{:016x}.json", seed);
}

/// Writes the scores as jobs; the folder of the run.
fs::path write_record(const fs::path& folder, const std::string& name, const Json& scores) {
  const std::uint64_t seed = scores["seed"];
  fs::create_directories(folder / "jobs");
  const fs::path list = folder / "jobs.csv";
  if (!fs::exists(list))
    put(list, CsvTable({"id", "scenario", "seed", "label", "estimator"}).text());
  CsvTable table({fmt::format("{:016x}", seed), name, fmt::format("{}", seed), "aims", "aims"});
  put(list, testing::content(list) + table.text());
  const Json job = {{"schema", kJobSchema},
                    {"outcome", "done"},
                    {"scores", scores["estimators"]["aims"]},
                    {"sequence", Json::object()}};
  put(job_file(folder, seed), job.dump());
  const fs::path run = folder / "runs" / name / fmt::format("seed-{}", seed);
  fs::create_directories(run);
  return run;
}

/// One scenario with seeds 1 to 6, ATE 0.1 m per seed and `more`.
void write_walk_suite(const fs::path& folder, double more = 0.0) {
  write_suite_json(folder, Json::array({scenario("walk", {1, 2, 3, 4, 5, 6})}));
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    write_record(folder, "walk", record(seed, 0.1 * static_cast<double>(seed) + more, seed != 2));
  }
}

TEST(SuitePage, OfOneScenarioIsTitledByIt) {
  const TemporaryFolder folder;
  write_walk_suite(folder.path() / "out");
  const auto page = suite_page(folder.path() / "out", {});
  ASSERT_TRUE(page) << page.error().message;
  EXPECT_EQ(page->title, "walk");
}

Json detectors(std::size_t points) {
  Json curve = Json::array();
  for (std::size_t i = 0; i < points; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(points - 1);
    curve.push_back({share, std::sqrt(share)});
  }
  const Json pooled = {{"scenario", nullptr}, {"index", "D"}, {"auc", 0.75}, {"curve", curve}};
  Json single = pooled;
  single["scenario"] = "walk";
  return {{"schema", "aims.detectors/2"}, {"estimator", "aims"}, {"scores", {pooled, single}}};
}

std::string message_of(const fs::path& folder, const PageOptions& options = {}) {
  const auto page = suite_page(folder, options);
  return page ? "" : page.error().message;
}

PageOptions against(const fs::path& folder) {
  PageOptions options;
  options.against = folder;
  return options;
}

PageOptions with_detectors(const fs::path& folder) {
  PageOptions options;
  options.detectors = folder;
  return options;
}

PageOptions laid_into(const fs::path& folder) {
  PageOptions options;
  options.out_folder = folder;
  return options;
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(SuitePage, HoldsTheSuiteAndEachRunsScores) {
  const TemporaryFolder folder;
  write_walk_suite(folder.path());
  const auto page = suite_page(folder.path(), {});
  ASSERT_TRUE(page) << page.error().message;
  EXPECT_EQ(page->json["suite"], Json::parse(testing::content(folder.path() / "suite.json")));
  EXPECT_EQ(page->json["schema"], kPageSchema);
  EXPECT_EQ(page->json["kind"], "suite");
  EXPECT_EQ(page->json["version"], "1.2.3");
  const Json& runs = page->json["runs"];
  ASSERT_EQ(runs.size(), 6U);
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const Json& run = runs[seed - 1];
    EXPECT_EQ(run["seed"], seed);
    const Json& outcome = run["estimators"]["aims"];
    EXPECT_DOUBLE_EQ(outcome["ate_m"], 0.1 * static_cast<double>(seed));
    EXPECT_DOUBLE_EQ(outcome["m_list_percent.all"], static_cast<double>(seed));
    EXPECT_TRUE(outcome["m_end_m"].is_null());
    EXPECT_EQ(outcome["success"], seed != 2);
    EXPECT_EQ(outcome["diverged_reason"], seed == 2 ? "error_limit" : "");
  }
  EXPECT_EQ(runs[1]["estimators"]["aims"]["diverged_at_s"], 12.5);
}

TEST(SuitePage, OfABenchmarkLeadsWithItsScore) {
  const TemporaryFolder folder;
  write_suite_json(folder.path(), Json::array({scenario("short", {1})}));
  Json scores = record(1, 0.1);
  scores["estimators"]["aims"]["control_points"] = {{"score", 60.0}};
  write_record(folder.path(), "short", scores);
  const Json benchmark = {
      {"schema", "aims.benchmark/1"},    {"title", "A data set"}, {"citation", "someone"},
      {"score", "control_points.score"}, {"unit", "of 100"},      {"notes", {"cite: someone"}}};
  put(folder.path() / "benchmark.json", benchmark.dump());
  const auto page = suite_page(folder.path(), {});
  ASSERT_TRUE(page) << page.error().message;
  EXPECT_EQ(page->title, "A data set");
  const Json first = page->json["score_list"][0];
  EXPECT_EQ(first["key"], "control_points.score");
  EXPECT_EQ(first["unit"], "of 100");
  EXPECT_EQ(first["better"], "larger");
  EXPECT_EQ(page->json["headline"][0], first["key"]);
  EXPECT_EQ(page->json["headline"][1], "ate_yaw_m");
  EXPECT_EQ(page->json["runs"][0]["estimators"]["aims"]["control_points.score"], 60.0);
  EXPECT_EQ(page->json["benchmark"], benchmark);
  put(folder.path() / "benchmark.json", "{}");
  const auto broken = suite_page(folder.path(), {});
  ASSERT_TRUE(broken);
  EXPECT_TRUE(broken->json["benchmark"].is_null());
  EXPECT_EQ(broken->json["headline"][0], "ate_yaw_m");
}

TEST(SuitePage, LinksToTheRunsThatHaveAPageFromWhereItLies) {
  const TemporaryFolder folder;
  const fs::path suite = folder.path() / "suite";
  write_walk_suite(suite);
  put(suite / "runs/walk/seed-3/page.html", "");
  const auto own = suite_page(suite, {});
  const auto other = suite_page(suite, laid_into(folder.path() / "elsewhere"));
  ASSERT_TRUE(own && other);
  EXPECT_TRUE(own->json["runs"][0]["href"].is_null());
  EXPECT_EQ(own->json["runs"][2]["href"], "runs/walk/seed-3/page.html");
  EXPECT_EQ(other->json["runs"][2]["href"], "../suite/runs/walk/seed-3/page.html");
}

TEST(SuitePage, LinksCarryNothingThatMeansSomethingElse) {
  EXPECT_EQ(link_to("runs/a b#1?x=%41:&\"<>'"), "runs/a%20b%231%3Fx%3D%2541%3A%26%22%3C%3E%27");
  EXPECT_EQ(link_to("runs/\xc3\xa9-_.~/seed-1"), "runs/%C3%A9-_.~/seed-1");
}

TEST(SuitePage, ARunThatCannotBeReadBecomesANote) {
  const TemporaryFolder folder;
  write_walk_suite(folder.path());
  fs::remove(job_file(folder.path(), 1));
  put(job_file(folder.path(), 4), R"({"schema": "aims.job/1", "outc)");
  const auto page = suite_page(folder.path(), {});
  ASSERT_TRUE(page) << page.error().message;
  EXPECT_TRUE(page->json["runs"][0]["estimators"].empty());
  EXPECT_FALSE(page->json["runs"][1]["estimators"].empty());
  EXPECT_TRUE(page->json["runs"][3]["estimators"].empty());
  ASSERT_EQ(page->json["notes"].size(), 2U);
  EXPECT_TRUE(contains(page->json["notes"][1], "walk, seed 4"));
}

TEST(SuitePage, DetectorCurvesKeepTheirEndsAndTheirAreas) {
  const TemporaryFolder folder;
  write_walk_suite(folder.path());
  put(folder.path() / "detectors.json", detectors(1000).dump());
  const auto page = suite_page(folder.path(), {});
  ASSERT_TRUE(page) << page.error().message;
  const auto read = decoded(payload_text(*page));
  const auto& scores = read.json["roc"]["scores"];
  EXPECT_EQ(scores[0]["auc"], 0.75);
  for (const auto& [score, points] : {std::pair(0, 400), std::pair(1, 60)}) {
    const auto curve = read.f32(scores[score]["curve"]);
    ASSERT_EQ(curve.size(), 2U * points);
    EXPECT_EQ(curve.front(), 0.0F);
    EXPECT_EQ(curve.back(), 1.0F);
    for (std::size_t i = 0; i < curve.size(); i += 2) {
      EXPECT_NEAR(curve[i + 1], std::sqrt(curve[i]), 1e-6);
    }
  }
}

TEST(SuitePage, DetectorsThatAreAskedForMustBeThereOthersNeedNot) {
  const TemporaryFolder folder;
  write_walk_suite(folder.path());
  EXPECT_TRUE(suite_page(folder.path(), {})->json["roc"].is_null());
  EXPECT_TRUE(contains(message_of(folder.path(), with_detectors(folder.path() / "no")), "no"));
  put(folder.path() / "detectors.json", R"({"schema": "aims.scores/1"})");
  const auto page = suite_page(folder.path(), {});
  ASSERT_TRUE(page);
  EXPECT_TRUE(page->json["roc"].is_null());
  EXPECT_TRUE(contains(page->json["notes"][0], "expected a document of schema aims.detectors/2"));
  EXPECT_TRUE(
      contains(message_of(folder.path(), with_detectors(folder.path())), "aims.detectors/2"));
}

TEST(SuitePage, ComparesAsAimsCompareDoesTheOtherBeingBefore) {
  const TemporaryFolder folder;
  const fs::path before = folder.path() / "before";
  const fs::path after = folder.path() / "after";
  write_walk_suite(before);
  write_walk_suite(after, 0.5);
  const auto page = suite_page(after, against(before));
  ASSERT_TRUE(page) << page.error().message;
  const auto expected = compare(*read_results(before), *read_results(after));
  Json json = page->json["compare"];
  EXPECT_EQ(json["summary"], summary_text(expected));
  EXPECT_EQ(json["differs"], settings_text(expected));
  json.erase("summary");
  json.erase("differs");
  EXPECT_EQ(json, comparison_json(expected, "before", "after"));
  EXPECT_GT(json["worse"], 0);
  EXPECT_TRUE(contains(message_of(after, against(folder.path() / "no")), "no finished results"));
}

TEST(SuitePage, ASuiteWithoutRunsIsAPage) {
  const TemporaryFolder folder;
  write_suite_json(folder.path(), Json::array());
  const auto page = suite_page(folder.path(), {});
  ASSERT_TRUE(page) << page.error().message;
  EXPECT_TRUE(page->json["runs"].empty());
  EXPECT_TRUE(page->json["notes"].empty());
}

TEST(SuitePage, AnythingElseSaysWhatWasExpected) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "suite.json";
  EXPECT_TRUE(contains(message_of(folder.path()), "suite.json"));
  for (const char* text :
       {"", "[1", "[]", "{}", R"({"schema": 5})", R"({"schema": "aims.suite/3"})",
        R"({"schema": "aims.suite/2"})", R"({"schema": "aims.suite/2", "scenarios": {}})",
        R"({"schema": "aims.suite/2", "scenarios": [3]})",
        R"({"schema": "aims.suite/2", "scenarios": [{"name": "a"}]})",
        R"({"schema": "aims.suite/2", "scenarios":
                              [{"name": "a", "seeds": [-1], "estimators": {}}]})"}) {
    put(file, text);
    const std::string message = message_of(folder.path());
    EXPECT_TRUE(contains(message, "suite.json") &&
                (contains(message, "expected") || contains(message, "incomplete")))
        << text << ": " << message;
  }
}

TEST(SuitePage, HostileNamesArriveAsTheyAre) {
  const TemporaryFolder folder;
  const std::string name = "a\nb\"<script>";
  write_suite_json(folder.path(), Json::array({scenario(name, {1}), scenario(kHostile, {1})}));
  put(write_record(folder.path(), name, record(1, 0.1)) / "page.html", "");
  const auto page = suite_page(folder.path(), {});
  ASSERT_TRUE(page) << page.error().message;
  const auto read = decoded(payload_text(*page));
  EXPECT_EQ(read.json["runs"][0]["scenario"], name);
  EXPECT_EQ(read.json["runs"][0]["href"], "runs/a%0Ab%22%3Cscript%3E/seed-1/page.html");
  EXPECT_EQ(read.json["suite"]["scenarios"][1]["name"], kHostile);
}

TEST(SuitePage, SameFolderSameBytes) {
  const TemporaryFolder folder;
  write_walk_suite(folder.path());
  put(folder.path() / "detectors.json", detectors(50).dump());
  EXPECT_EQ(payload_text(*suite_page(folder.path(), {})),
            payload_text(*suite_page(folder.path(), {})));
}

}  // namespace
}  // namespace aims
