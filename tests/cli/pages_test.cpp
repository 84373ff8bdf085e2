// SPDX-License-Identifier: BSD-3-Clause
// Pages that commands write beside their results, and what is shown while they draw.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "tests/cli/command_line.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;
using testing::Outcome;

class Pages : public testing::CommandLine {
 protected:
  bool exists(const std::string& file) const { return fs::exists(folder_.path() / file); }
};

TEST_F(Pages, AreWrittenByEstimateAndScore) {
  scenario(testing::kMetreWalk);
  ASSERT_EQ(aims("simulate my.yaml --out my.bag --quiet").exit_code, 0);
  const std::string estimate = "estimate my.bag --estimators leg --quiet ";
  const Outcome with = aims(estimate + "--out with");
  EXPECT_EQ(with.exit_code, 0) << with.output;
  EXPECT_TRUE(holds(with, "page: with/page.html")) << with.output;
  EXPECT_TRUE(exists("with/page.html"));
  EXPECT_TRUE(holds(with, "ATE yaw, heading: after least squares")) << with.output;
  EXPECT_EQ(aims(estimate + "--topics truth=none --out without").exit_code, 0);
  EXPECT_TRUE(exists("without/page.html")) << "an estimate without a truth has a page";
  const std::string score = "score --truth with/truth.tum --estimate with/leg.tum --name 'my leg' ";
  const Outcome scored = aims(score + "--out score");
  EXPECT_EQ(scored.exit_code, 0) << scored.output;
  EXPECT_TRUE(holds(scored, "page: score/page.html")) << scored.output;
  EXPECT_TRUE(holds(scored, "drawing score\n")) << scored.output;
  EXPECT_EQ(scored.output.find("drawing "), scored.output.rfind("drawing ")) << scored.output;
  EXPECT_NE(read_file(folder_.path() / "score/page.html").value().find("my leg against truth"),
            std::string::npos);
  EXPECT_TRUE(exists("score/my leg.tum")) << "which the page shows";
  EXPECT_EQ(aims(score + "--out score --overwrite --no-page").exit_code, 0);
  EXPECT_FALSE(exists("score/page.html")) << "it is a file of ours, so it is removed";
  EXPECT_FALSE(exists("score/page.html.kept"));
}

TEST_F(Pages, ManyAreCountedAndTheirCommonOneIsNamed) {
  scenario(testing::kMetreWalk);
  const std::string command = "run my.yaml --estimators leg --no-pictures --quiet --out out";
  const Outcome many = aims(command + " --seeds 1-6");
  EXPECT_TRUE(
      holds(many, "pages of 6 runs, out/seed-1/page.html and others\npage: out/page.html\n"))
      << many.output;
}

TEST_F(Pages, OfSeveralSeedsTheReasonOfAFailureIsNamed) {
  scenario(testing::kMetreWalk);
  const Outcome gap = aims(
      "run my.yaml --estimators leg --no-pictures --quiet --out out --seeds 1-2 "
      "--set scoring.max_gap=0.01");
  EXPECT_TRUE(holds(gap, "no success: leg on 2 of 2 seeds: gap: no poses for too long, at "))
      << gap.output;
  EXPECT_NE(read_file(folder_.path() / "out/summary.md")
                .value()
                .find("- No success: leg on 2 of 2 seeds: gap"),
            std::string::npos);
}

TEST_F(Pages, DrawingIsShownUnlessQuiet) {
  scenario(testing::kMetreWalk);
  const Outcome shown = aims("run my.yaml --estimators leg --out here");
  EXPECT_TRUE(holds(shown, "drawing here\n")) << shown.output;
  const Outcome quiet = aims("run my.yaml --estimators leg --out here --quiet");
  EXPECT_FALSE(holds(quiet, "drawing")) << quiet.output;
}

}  // namespace
}  // namespace aims
