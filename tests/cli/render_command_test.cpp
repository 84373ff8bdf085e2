// SPDX-License-Identifier: BSD-3-Clause
// `aims render` as a user calls it.
#include <nlohmann/json.hpp>

#include "tests/cli/command_line.hpp"
#include "tests/render/film/webp_file.hpp"

namespace aims::testing {
namespace {

namespace fs = std::filesystem;

constexpr const char* kShortWalk =
    "scene: {corridor: {length: 10}}\n"
    "route: {stand_before: 2.5, points: [{name: a, x: 0, y: 0}, {name: b, x: 1, y: 0}]}\n";

class RenderCommand : public CommandLine {
 protected:
  std::string content(const std::string& file) const {
    std::ifstream stream(folder_.path() / file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }

  void expect_refused(const std::string& arguments, const std::string& message) const {
    const Outcome outcome = aims("render " + arguments + " --quiet");
    EXPECT_EQ(outcome.exit_code, 2) << arguments;
    EXPECT_NE(outcome.output.find(message), std::string::npos) << outcome.output;
    EXPECT_FALSE(fs::exists(folder_.path() / "out")) << arguments;
  }
};

/// Pixels that differ by more than the compression changes.
int changed_pixels(const Image& a, const Image& b) {
  int count = 0;
  for (std::size_t i = 0; i < a.rgb.size(); i += 3) {
    const int apart = std::abs(a.rgb[i] - b.rgb[i]) + std::abs(a.rgb[i + 1] - b.rgb[i + 1]) +
                      std::abs(a.rgb[i + 2] - b.rgb[i + 2]);
    count += apart > 60 ? 1 : 0;
  }
  return count;
}

TEST_F(RenderCommand, WritesEverythingThatItIsAskedFor) {
  const std::string what = "render " + scenario(kShortWalk) +
                           " --estimators leg --still --video walk.webp --svg --pdf --size 240x180 "
                           "--still-size 320x240 --fps 3 --seconds 2 --quiet";
  const Outcome outcome = aims(what + " --jobs 1 --out first");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;

  const auto movie = test::read_webp(content("first/walk.webp"));
  EXPECT_EQ(movie.loops, 0);
  ASSERT_EQ(movie.frames.size(), 6U);
  EXPECT_EQ(movie.frames.front().width, 240);
  EXPECT_EQ(movie.frames.front().height, 180);
  for (std::size_t i = 1; i < movie.frames.size(); ++i) {
    EXPECT_GT(changed_pixels(movie.frames[i - 1], movie.frames[i]), 50) << i;
  }

  const auto record = nlohmann::json::parse(content("first/render.json"));
  EXPECT_EQ(record["schema"], "aims.render/1");
  EXPECT_EQ(record["map_of"], "leg");
  const auto at_first = record["video"]["map_points_first"].get<int>();
  EXPECT_GT(at_first, 100);
  EXPECT_GT(record["video"]["map_points"].get<int>(), at_first) << "the map grows";

  for (const char* name : {"trajectories", "leg-map-top", "leg-map-side"}) {
    const std::string file = std::string("first/") + name;
    const std::string svg = content(file + ".svg");
    EXPECT_NE(svg.find("<svg"), std::string::npos) << file;
    EXPECT_NE(svg.find("</svg>"), std::string::npos) << file;
    EXPECT_EQ(content(file + ".pdf").rfind("%PDF-", 0), 0U) << file;
    EXPECT_NE(content(file + ".pdf").find("%%EOF"), std::string::npos) << file;
  }

  const Outcome again = aims(what + " --jobs 2 --out second");
  ASSERT_EQ(again.exit_code, 0) << again.output;
  for (const auto& entry : fs::directory_iterator(folder_.path() / "first")) {
    const std::string name = entry.path().filename().string();
    EXPECT_TRUE(content("first/" + name) == content("second/" + name)) << name;
  }
}

TEST_F(RenderCommand, DrawsVectorPicturesFromTheFilesOfARun) {
  const Outcome run = aims("run " + scenario(kShortWalk) +
                           " --estimators aims,leg --no-pictures --quiet --out walked");
  ASSERT_EQ(run.exit_code, 0) << run.output;
  const Outcome outcome = aims("render walked --svg --out drawn --quiet");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_TRUE(fs::exists(folder_.path() / "drawn/trajectories.svg")) << outcome.output;
  EXPECT_TRUE(fs::exists(folder_.path() / "drawn/aims-map-top.svg")) << outcome.output;
  EXPECT_FALSE(fs::exists(folder_.path() / "drawn/still.png"));
  const Outcome unknown = aims("render walked --svg --estimators lio --out other --quiet");
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_NE(unknown.output.find("no estimator 'lio'; there are aims, leg"), std::string::npos)
      << unknown.output;
  const Outcome exists = aims("render walked --svg --out drawn --quiet");
  EXPECT_EQ(exists.exit_code, 2);
  EXPECT_NE(exists.output.find("--overwrite"), std::string::npos) << exists.output;
  EXPECT_EQ(aims("render walked --svg --out drawn --overwrite --quiet").exit_code, 0);
  EXPECT_EQ(aims("render walked --svg --out walked --quiet").exit_code, 2);
}

TEST_F(RenderCommand, RefusesWhatItCannotDraw) {
  const std::string walk = scenario(kShortWalk);
  expect_refused("nowhere", "nowhere");
  expect_refused(walk + " --size 640", "--size '640': expected WIDTHxHEIGHT");
  expect_refused(walk + " --still-size 640x", "--still-size '640x': expected WIDTHxHEIGHT");
  expect_refused(walk + " --video walk.gif", ".webp, .mp4 or .webm");
  expect_refused(walk + " --video ../walk.webp", "without a folder");
  expect_refused(walk + " --video walk.webp --seconds 600 --fps 60", "frames; expected 2 to");
  expect_refused(walk + " --video walk.mp4 --size 641x400", "even");
  expect_refused(walk + " --view inside", "--view");
  expect_refused(walk + " --fps 0", "--fps");
  expect_refused(walk + " --seeds 1-3", "one seed");
  expect_refused(walk + " --estimators lioo", "did you mean 'lio'?");
}

TEST_F(RenderCommand, SaysThatFfmpegIsMissing) {
  const Outcome outcome =
      shell("PATH=/nowhere '" AIMS_COMMAND "' render " + scenario(kShortWalk) + " --video a.webm");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.output.find("ffmpeg"), std::string::npos) << outcome.output;
}

}  // namespace
}  // namespace aims::testing
