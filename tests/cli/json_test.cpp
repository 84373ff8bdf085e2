// SPDX-License-Identifier: BSD-3-Clause
// --json: one document on standard output, nothing else.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "bench/scoring/json_text.hpp"
#include "tests/cli/command_line.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;
using testing::Outcome;

class JsonOutput : public testing::CommandLine {
 protected:
  /// What the command writes on standard output alone.
  Json json_of(const std::string& arguments, const std::string& schema) const {
    const Outcome outcome = shell("('" AIMS_COMMAND "' " + arguments + " --json 2>/dev/null)");
    EXPECT_EQ(outcome.exit_code, 0) << arguments << "\n" << outcome.output;
    Json json = Json::parse(outcome.output, nullptr, false);
    EXPECT_TRUE(json.is_object()) << arguments << "\n" << outcome.output;
    if (json.is_object()) {
      EXPECT_EQ(json.value("schema", ""), schema) << arguments;
    }
    return json;
  }
};

/// The entry of an array whose `key` is `value`; null when there is none.
Json entry_of(const Json& array, const std::string& key, const std::string& value) {
  for (const Json& each : array) {
    if (each.value(key, "") == value) return each;
  }
  return {};
}

TEST_F(JsonOutput, OfListHoldsScenariosFamiliesAndEstimators) {
  const Json list = json_of("list --folder '" AIMS_SCENARIOS "'", "aims.list/1");
  const Json corridor = entry_of(list["scenarios"], "name", "corridor");
  EXPECT_EQ(corridor["tags"], Json::parse(R"(["paper", "corridor"])"));
  EXPECT_TRUE(corridor["error"].is_null());
  const Json severity = entry_of(list["families"], "name", "severity");
  EXPECT_EQ(severity["scenarios"][0], "severity_0");
  EXPECT_FALSE(entry_of(list["estimators"], "name", "aims_d").is_null());
}

TEST_F(JsonOutput, OfConfigHoldsTypedValuesAndTheirLimits) {
  scenario(testing::kMetreWalk);
  const Json config = json_of("config my.yaml --set lidar.range_max=30", "aims.config/1");
  EXPECT_EQ(config["name"], "my");
  const Json range = entry_of(config["parameters"], "key", "lidar.range_max");
  EXPECT_EQ(range["value"], 30.0);
  EXPECT_EQ(range["unit"], "m");
  EXPECT_TRUE(range["no_effect"].is_null());
  EXPECT_TRUE(entry_of(config["parameters"], "key", "seed")["value"].is_number_integer());
  EXPECT_EQ(entry_of(config["parameters"], "key", "seed")["min"], 0.0);
  EXPECT_EQ(entry_of(config["parameters"], "key", "route.points.1.name")["value"], "b");
  EXPECT_EQ(entry_of(config["lists"], "key", "route.points")["entries"], 2);
  const Json one = json_of("config --estimator aims_d", "aims.config/1");
  EXPECT_TRUE(entry_of(one["parameters"], "key", "lidar.range_max").is_null());
}

TEST_F(JsonOutput, OfABagHoldsTopicsAndRequirements) {
  scenario(testing::kMetreWalk);
  ASSERT_EQ(aims("simulate my.yaml --out my.bag --quiet").exit_code, 0);
  const Json info = json_of("info my.bag", "aims.info/1");
  const Json imu = entry_of(info["topics"], "topic", "/imu/data");
  EXPECT_EQ(imu["type"], "sensor_msgs/Imu");
  EXPECT_NEAR(imu["rate_hz"].get<double>(), 50.0, 1.0);
  EXPECT_EQ(info["used"]["lidar"], "/lidar/points");
  EXPECT_EQ(entry_of(info["clouds"], "topic", "/lidar/points")["ring_field"], "ring");
  const Json check = json_of("check my.bag --system FAST-LIO2", "aims.check/1");
  ASSERT_FALSE(check["requirements"].empty());
  for (const Json& each : check["requirements"]) EXPECT_EQ(each["system"], "FAST-LIO2");
}

TEST_F(JsonOutput, OfScoreAndCompareIsWhatTheirFilesHold) {
  write("truth.tum",
        "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n2 2 0 0 0 0 0 1\n3 3 0 0 0 0 0 1\n4 4 0 0 0 0 0 1\n");
  const std::string score = "score --truth truth.tum --estimate truth.tum --name mine --out s ";
  const Json scores = json_of(score, "aims.scores/2");
  EXPECT_EQ(scores["estimators"]["mine"]["ate_m"], 0.0);
  EXPECT_TRUE(fs::exists(folder_.path() / "s" / "page.html")) << "a page is written too";
  const Outcome compared =
      shell("('" AIMS_COMMAND "' study compare s s --json --out c 2>/dev/null)");
  EXPECT_EQ(Json::parse(compared.output, nullptr, false)["worse"], 0) << compared.output;
  EXPECT_EQ(shell("cat c/compare.json").output, compared.output);
}

TEST_F(JsonOutput, OfRunsAndSuitesIsWhatTheirFilesHold) {
  scenario(testing::kMetreWalk);
  const std::string options = " --estimators leg --seeds 1-2 --cache walks --no-page ";
  const Json run = json_of("run my.yaml --no-pictures --out r" + options, "aims.run/1");
  ASSERT_EQ(run["runs"].size(), 2);
  EXPECT_EQ(run["runs"][1], Json::parse(shell("cat r/seed-2/scores.json").output));
  const Json suite = json_of("suite my.yaml --out s" + options, "aims.suite/2");
  EXPECT_EQ(suite, Json::parse(shell("cat s/suite.json").output));
}

TEST_F(JsonOutput, OfAnEstimateHoldsItsScores) {
  scenario(testing::kMetreWalk);
  ASSERT_EQ(aims("simulate my.yaml --out my.bag --quiet").exit_code, 0);
  const Json json = json_of("estimate my.bag --estimators leg --out e", "aims.estimate/1");
  EXPECT_EQ(json["scores"], Json::parse(shell("cat e/scores.json").output));
  EXPECT_EQ(json["estimators"]["leg"]["poses"],
            Json::parse(shell("cat e/estimate.json").output)["estimators"]["leg"]["poses"]);
}

TEST_F(JsonOutput, OfSweepAndTuneHoldsEveryPointAndTheVerdict) {
  scenario(testing::kMetreWalk);
  const Json sweep = json_of(
      "sweep --param max_speed=1:2:3 --scenarios my.yaml --estimators leg --cache walks --out s",
      "aims.sweep/1");
  EXPECT_EQ(sweep["jobs"]["done"], 4) << "three points and the default";
  ASSERT_EQ(sweep["estimators"][0]["points"].size(), 4);
  EXPECT_EQ(sweep["estimators"][0]["points"][0]["default"], true);
  EXPECT_EQ(sweep["estimators"][0]["points"][2]["values"]["max_speed"], 1.5);
  write("plan.yaml",
        "estimator: leg\nparams: [\"queue.max_ahead=60:150\", \"max_speed=log(1,4)\"]\n"
        "scenarios: [my.yaml]\nseeds: 1\nheld_out: {seeds: 2}\n"
        "objectives: [{score: ate_m}, {score: m_end_m}]\n"
        "optimizer: {generations: 1, population: 8}\n");
  const Json tune = json_of("tune plan.yaml --cache walks --out t", "aims.tune/1");
  ASSERT_FALSE(tune["chosen"].empty());
  EXPECT_EQ(tune["chosen"][0]["objectives"].size(), 2);
  EXPECT_TRUE(tune["defaults"]["values"].contains("max_speed"));
  EXPECT_NE(tune["verdict"].get<std::string>().find("the Pareto front has no other point"),
            std::string::npos)
      << tune["verdict"];
}

TEST_F(JsonOutput, OfARefusedInputIsTheError) {
  scenario(testing::kMetreWalk);
  for (const char* arguments :
       {"run nowhere", "suite nowhere", "estimate nowhere.bag", "sweep --scenarios my.yaml --bad",
        "tune nowhere.yaml", "list --tags nowhere", "config nowhere", "study compare no where",
        "score --truth no --estimate where", "run my.yaml --set lidar.range=3"}) {
    const Outcome outcome =
        shell(std::string("('" AIMS_COMMAND "' ") + arguments + " --json 2>/dev/null)");
    EXPECT_EQ(outcome.exit_code, 2) << arguments;
    const Json json = Json::parse(outcome.output, nullptr, false);
    ASSERT_TRUE(json.is_object()) << arguments << "\n" << outcome.output;
    EXPECT_EQ(json.size(), 1) << arguments;
    EXPECT_FALSE(json.value("error", "").empty()) << arguments;
  }
}

}  // namespace
}  // namespace aims
