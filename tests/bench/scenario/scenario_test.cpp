// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scenario/scenario.hpp"

#include <gtest/gtest.h>
#include <sys/inotify.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <map>
#include <set>
#include <span>

#include "bench/scenario/catalogue.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

class ScenarioFolder : public ::testing::Test {
 protected:
  void write(const fs::path& name, const char* yaml) const {
    fs::create_directories((folder_.path() / name).parent_path());
    std::ofstream(folder_.path() / name) << yaml;
  }
  TemporaryFolder folder_;
};

TEST_F(ScenarioFolder, IsSearchedToItsDepthByBareName) {
  write("plain.yaml", "seed: 4");
  write("stress/loss/half.yaml", "{base: ../../plain.yaml, family: loss, level: 0.5}");
  const auto file = find_scenario("half", folder_.path());
  ASSERT_TRUE(file) << file.error().message;
  const auto scenario = load_scenario(*file, {});
  ASSERT_TRUE(scenario) << scenario.error().message;
  EXPECT_EQ(scenario->name, "half");
  EXPECT_EQ(scenario->seed, 4);
  EXPECT_EQ(scenario->family, "loss");
  EXPECT_EQ(scenario->level, 0.5);
  const auto typo = find_scenario("hall", folder_.path());
  ASSERT_FALSE(typo);
  EXPECT_NE(typo.error().message.find("did you mean 'half'?"), std::string::npos);
}

TEST_F(ScenarioFolder, ItsWrittenConfigurationIsReadAgain) {
  write("limited.yaml", "expect: [{estimator: aims, score: ate_m, max: 0.1}]");
  const auto scenario = load_scenario(folder_.path() / "limited.yaml", {});
  ASSERT_TRUE(scenario) << scenario.error().message;
  write("again.yaml", effective_config(*scenario, 1).c_str());
  const auto again = load_scenario(folder_.path() / "again.yaml", {});
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(again->expect.front().min, -kNoLimit);
}

TEST_F(ScenarioFolder, ItsDescriptionNamesWhatWasSetOnTopOfTheFile) {
  write("plain.yaml", "description: A wide hall.");
  const auto description = [&](const std::vector<std::string>& settings) {
    const auto scenario = load_scenario(folder_.path() / "plain.yaml", settings);
    EXPECT_TRUE(scenario) << scenario.error().message;
    write("again.yaml", effective_config(*scenario, 1).c_str());
    return load_scenario(folder_.path() / "again.yaml", {})->description;
  };
  EXPECT_EQ(description({}), "A wide hall.");
  EXPECT_EQ(description({"estimators.aims.degeneracy.eta=5"}), "A wide hall.");
  EXPECT_EQ(description({"lidar.columns=450"}),
            "A wide hall. With changed settings: lidar.columns=450.");
  write("plain.yaml", "description: A hall");
  EXPECT_EQ(description({"lidar.columns=450"}),
            "A hall. With changed settings: lidar.columns=450.");
}

/// How often `work` opens the file.
template <class Work>
std::size_t openings(const fs::path& file, const Work& work) {
  const int inotify = inotify_init1(IN_NONBLOCK);
  EXPECT_GE(inotify_add_watch(inotify, file.c_str(), IN_OPEN | IN_CLOSE), 0);
  work();
  std::array<inotify_event, 100> events{};
  const auto bytes = ::read(inotify, events.data(), sizeof(events));
  ::close(inotify);
  const std::span found(events.data(), std::max<ssize_t>(bytes, 0) / sizeof(inotify_event));
  return std::ranges::count_if(found, [](const auto& each) { return (each.mask & IN_OPEN) != 0; });
}

TEST_F(ScenarioFolder, EachFileOfAScenarioIsReadOnce) {
  write("plain.yaml", "{run: [lio], seed: 4}");
  write("half.yaml", "{base: plain, level: 0.5}");
  write("settings.yaml", "{run: [leg], seed: 5}");
  const std::vector<std::string> settings = {"@" + (folder_.path() / "settings.yaml").string()};
  for (const char* name : {"plain.yaml", "half.yaml", "settings.yaml"}) {
    const std::size_t opened = openings(folder_.path() / name, [&] {
      const auto scenario = load_scenario(folder_.path() / "half.yaml", settings);
      ASSERT_TRUE(scenario) << scenario.error().message;
      EXPECT_EQ(scenario->run, std::vector<std::string>{"leg"});
      EXPECT_EQ(scenario->seed, 5);
    });
    EXPECT_EQ(opened, 1U) << name;
  }
}

TEST_F(ScenarioFolder, RefusesTwoFilesOfOneName) {
  write("a/same.yaml", "seed: 1");
  write("b/same.yaml", "seed: 2");
  const auto found = find_scenario("same", folder_.path());
  ASSERT_FALSE(found);
  EXPECT_NE(found.error().message.find("two scenarios of the same name"), std::string::npos);
  EXPECT_FALSE(scenarios_in(folder_.path(), {}));
}

/// The shipped scenarios, loaded once for all tests of the suite.
const std::vector<ScenarioFile>& shipped() {
  static const std::vector<ScenarioFile> files = scenarios_in(AIMS_SCENARIOS, {}).value();
  return files;
}

TEST(ShippedScenarios, ExpectNoEstimatorToFail) {
  for (const auto& [file, scenario] : shipped()) {
    ASSERT_TRUE(scenario) << scenario.error().message;
    for (const Expectation& expectation : scenario->expect) {
      if (expectation.score != "success" && expectation.score != "optimized.success") continue;
      EXPECT_GE(expectation.max, 1.0)
          << file << ": " << expectation.estimator << " must fail: a better one would break this";
    }
  }
}

TEST(ShippedScenarios, OfStressDrawTheirOwnSensors) {
  std::size_t stress = 0;
  for (const auto& [file, scenario] : shipped()) {
    const bool of_stress = std::ranges::count(scenario->tags, "stress") > 0;
    const std::string& draw = scenario->simulation.sensor_draw;
    EXPECT_TRUE(draw == scenario->name || (draw.empty() && !of_stress)) << file << ": " << draw;
    stress += of_stress;
  }
  EXPECT_GT(stress, 80U);
}

TEST(ShippedScenarios, LoadAndAreCalledAsTheirFiles) {
  EXPECT_FALSE(shipped().empty());
  for (const auto& [file, scenario] : shipped()) {
    ASSERT_TRUE(scenario) << scenario.error().message;
    EXPECT_EQ(scenario->name, file.stem().string()) << "a name from a base?";
  }
}

TEST(ShippedScenarios, HaveHeadsThatAreThoseOfTheWholeScenarios) {
  const auto heads = scenario_heads(AIMS_SCENARIOS, {});
  ASSERT_TRUE(heads);
  ASSERT_EQ(shipped().size(), heads->size());
  for (std::size_t i = 0; i < shipped().size(); ++i) {
    const Result<ScenarioHead>& head = (*heads)[i].head;
    const Scenario& whole = *shipped()[i].scenario;
    ASSERT_TRUE(head) << head.error().message;
    EXPECT_EQ(head->name, whole.name);
    EXPECT_EQ(head->description, whole.description);
    EXPECT_EQ(head->tags, whole.tags);
    EXPECT_EQ(head->family, whole.family);
    EXPECT_EQ(head->level, whole.level);
    EXPECT_EQ(head->level_unit, whole.level_unit);
  }
}

TEST_F(ScenarioFolder, ATagFindsItsScenariosWhateverElseIsBroken) {
  write("right.yaml", "tags: [mine]");
  write("wrong.yaml", "tags: [other]\nsedd: 1");
  const std::vector<std::string> tags = {"mine"};
  const auto files = scenarios_in(folder_.path(), tags);
  ASSERT_TRUE(files) << files.error().message;
  ASSERT_EQ(files->size(), 1U);
  EXPECT_TRUE(files->front().scenario);
}

TEST(ShippedScenarios, OfAFamilyShareItsUnitAndDifferInLevel) {
  std::map<std::string, std::string> units;
  std::set<std::pair<std::string, double>> levels;
  for (const auto& [file, scenario] : shipped()) {
    if (!scenario || scenario->family.empty()) continue;
    const auto [unit, is_new] = units.emplace(scenario->family, scenario->level_unit);
    EXPECT_EQ(unit->second, scenario->level_unit) << file;
    EXPECT_TRUE(levels.emplace(scenario->family, scenario->level).second) << file;
  }
}

}  // namespace
}  // namespace aims
