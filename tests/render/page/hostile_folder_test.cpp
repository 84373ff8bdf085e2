// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "render/page/page.hpp"
#include "render/page/page_template.hpp"
#include "render/page/pages.hpp"
#include "render/page/run_folder.hpp"
#include "tests/render/page/decoded_page.hpp"
#include "tests/render/page/written_run.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;
using testing::content;
using testing::DecodedPage;
using testing::put;

class HostileFolder : public ::testing::Test {
 protected:
  HostileFolder() { testing::write_run(run_, {.scans = 5, .map_points = 20}); }

  DecodedPage page() const {
    const auto made = run_page(run_);
    EXPECT_TRUE(made) << made.error().message;
    return made ? testing::decoded(payload_text(*made)) : DecodedPage{};
  }

  /// The page is refused with a line that holds each of the texts.
  void expect_refused(const std::vector<std::string>& texts) const {
    const auto made = run_page(run_);
    ASSERT_FALSE(made);
    for (const std::string& text : texts) {
      EXPECT_NE(made.error().message.find(text), std::string::npos) << made.error().message;
    }
  }

  TemporaryFolder folder_;
  fs::path run_ = folder_.path() / "run";
};

TEST_F(HostileFolder, ScenarioNamedAsAScriptStaysText) {
  const std::string name = "<script>alert('x')</script>";
  fs::remove_all(run_);
  testing::write_run(run_, {.name = name, .scans = 5});
  const auto made = run_page(run_);
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_EQ(testing::decoded(payload_text(*made)).json["scenario"]["name"], name);
  const auto html = filled_template("<title>__AIMS_TITLE__</title>__AIMS_DATA__", *made);
  ASSERT_TRUE(html);
  EXPECT_EQ(html->find("<script>alert"), std::string::npos);
}

TEST_F(HostileFolder, EstimatorNamedAsAPathReadsNoFileOutsideTheFolder) {
  put(folder_.path() / "secret.tum", "0.1 0 0 0 0 0 0 1\n");
  auto scores = nlohmann::json::parse(content(run_ / "scores.json"));
  scores["estimators"]["../secret"] = {{"success", false}};
  put(run_ / "scores.json", scores.dump());
  const DecodedPage decoded = page();
  bool found = false;
  for (const auto& estimator : decoded.json["estimators"]) {
    if (estimator["name"] != "../secret") continue;
    found = true;
    EXPECT_TRUE(estimator["series"].is_null());
  }
  EXPECT_TRUE(found);
}

TEST_F(HostileFolder, ALinkToAFileOutsideIsRefused) {
  put(folder_.path() / "secret.png", "\x89PNG\r\n\x1a\n the reader's own");
  fs::remove(run_ / "trajectories.png");
  fs::create_symlink("../secret.png", run_ / "trajectories.png");
  expect_refused({"trajectories.png", "outside the folder"});
  fs::remove(run_ / "trajectories.png");
  put(folder_.path() / "secret.yaml", content(run_ / "config.yaml"));
  fs::remove(run_ / "config.yaml");
  fs::create_symlink(folder_.path() / "secret.yaml", run_ / "config.yaml");
  expect_refused({"config.yaml", "outside the folder"});
}

TEST_F(HostileFolder, ALinkInsideTheFolderIsFollowed) {
  fs::create_symlink("truth.tum", run_ / "other.tum");
  const DecodedPage decoded = page();
  EXPECT_TRUE(std::any_of(decoded.json["estimators"].begin(), decoded.json["estimators"].end(),
                          [](const auto& each) { return each["name"] == "other"; }));
}

TEST_F(HostileFolder, APictureThatIsNoneIsLeftOut) {
  put(run_ / "trajectories.png", "<svg onload=alert(1)>");
  const DecodedPage decoded = page();
  for (const auto& each : decoded.json["pictures"]) EXPECT_NE(each["name"], "trajectories");
  EXPECT_NE(decoded.json["notes"].dump().find("trajectories.png is no PNG"), std::string::npos);
}

TEST_F(HostileFolder, MissingFilesLeaveTheirPartEmpty) {
  for (const char* name : {"truth.tum", "localizability.csv", "waypoint_times.csv", "exact.tum",
                           "ahead.diagnostics.csv", "ahead.map.ply", "config.yaml"}) {
    fs::remove(run_ / name);
  }
  const DecodedPage decoded = page();
  EXPECT_TRUE(decoded.json["truth"].is_null());
  EXPECT_TRUE(decoded.json["localizability"].is_null());
  EXPECT_TRUE(decoded.json["scene"].is_null());
  EXPECT_TRUE(decoded.json["legs"].is_null());
  EXPECT_TRUE(decoded.json["estimators"][0]["series"].is_null());
  EXPECT_FALSE(decoded.json["estimators"][1]["series"]["p"].is_null());
  EXPECT_TRUE(decoded.json["estimators"][1]["series"].value("D", nlohmann::json()).is_null());
  EXPECT_TRUE(decoded.json["estimators"][1]["map"].is_null());
  EXPECT_EQ(decoded.json["notes"].size(), 1U);
}

TEST_F(HostileFolder, RunWithoutAnyScanAndRunWithOneGiveAPage) {
  for (const int scans : {0, 1}) {
    fs::remove_all(run_);
    testing::write_run(run_, {.scans = scans, .map_points = scans});
    const DecodedPage decoded = page();
    EXPECT_EQ(decoded.json["estimators"].size(), 2U) << scans;
    EXPECT_EQ(decoded.json["truth"].is_null(), scans == 0);
    EXPECT_EQ(decoded.json["estimators"][0]["map"].is_null(), scans == 0);
  }
}

TEST_F(HostileFolder, NumbersThatAreNoneBecomeNone) {
  std::string text = content(run_ / "exact.diagnostics.csv");
  const std::size_t line = text.find('\n') + 1;
  std::string row = text.substr(line, text.find('\n', line) - line);
  for (std::size_t at = row.find(",0,"); at != std::string::npos; at = row.find(",0,")) {
    row.replace(at, 3, ",nan,");
  }
  put(run_ / "exact.diagnostics.csv", text.substr(0, line) + row + "\n");
  put(run_ / "ahead.tum", "0.1 nan 0 0 0 0 0 1\n0.2 0 0 0 0 0 0 1\n0.15 0 0 0 0 0 0 1\n");
  const DecodedPage decoded = page();
  EXPECT_EQ(decoded.f32(decoded.json["estimators"][1]["series"]["t"]).size(), 1U);
}

TEST_F(HostileFolder, CutOrBrokenFileIsNamedWithItsLine) {
  const std::string table = content(run_ / "exact.diagnostics.csv");
  put(run_ / "exact.diagnostics.csv", table.substr(0, table.size() - 40));
  expect_refused({"exact.diagnostics.csv:6", "50 cells"});
  put(run_ / "exact.diagnostics.csv", "stamp_s,D\n0.1,much\n");
  expect_refused({"exact.diagnostics.csv:2", "D", "a number", "'much'"});
  put(run_ / "exact.diagnostics.csv", "");
  expect_refused({"exact.diagnostics.csv:1", "header"});
}

TEST_F(HostileFolder, CutMapIsNamedWithWhatWasExpected) {
  const std::string map = content(run_ / "exact.map.ply");
  put(run_ / "exact.map.ply", map.substr(0, map.size() - 5));
  expect_refused({"exact.map.ply", "20 vertices of 12 bytes"});
}

TEST_F(HostileFolder, CutScoresAreNamed) {
  put(run_ / "scores.json", "{\"schema\": \"aims.sco");
  expect_refused({"scores.json", "JSON"});
}

TEST_F(HostileFolder, ConfigurationOfAnotherVersionLeavesOutTheScene) {
  std::ofstream(run_ / "config.yaml", std::ios::app) << "key_of_tomorrow: 1\n";
  const DecodedPage decoded = page();
  EXPECT_TRUE(decoded.json["scene"].is_null());
  ASSERT_EQ(decoded.json["notes"].size(), 1U);
  EXPECT_NE(decoded.json["notes"][0].get<std::string>().find("key_of_tomorrow"), std::string::npos);
  EXPECT_FALSE(decoded.json["estimators"][0]["series"].is_null());
}

TEST_F(HostileFolder, FolderWithoutResultsIsRefusedWithWhatWasExpected) {
  const auto written = write_pages(folder_.path());
  ASSERT_FALSE(written);
  const std::string expected = page_template(PageKind::kRun).empty() ? "AIMS_PAGE" : "scores.json";
  EXPECT_NE(written.error().message.find(expected), std::string::npos) << written.error().message;
}

}  // namespace
}  // namespace aims
