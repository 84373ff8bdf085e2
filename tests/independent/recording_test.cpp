// SPDX-License-Identifier: BSD-3-Clause
#include "tests/independent/recording.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <variant>
#include <vector>

#include "core/files/atomic_file.hpp"
#include "core/files/tum.hpp"
#include "core/files/waypoint_times.hpp"
#include "recordings/stream/recording_reader.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims::independent {
namespace {

namespace fs = std::filesystem;

RecordingOptions short_options() {
  RecordingOptions options;
  options.imu_rate_hz = 100.0;
  options.length = 2.0;
  return options;
}

TEST(IndependentRecording, TheSameSeedGivesTheSameBytesAndAnotherOthers) {
  const TemporaryFolder folder;
  RecordingOptions options = short_options();
  for (const char* name : {"a", "b", "c"}) {
    options.seed = *name == 'c' ? 2 : 1;
    ASSERT_TRUE(write_recording(options, folder.path() / (std::string(name) + ".bag")));
  }
  for (const char* extension : {".bag", ".truth.tum", ".waypoint_times.csv"}) {
    const auto text = [&](const char* name) {
      return *read_file(folder.path() / (name + std::string(extension)));
    };
    EXPECT_TRUE(text("a") == text("b")) << extension;
  }
  EXPECT_FALSE(*read_file(folder.path() / "a.bag") == *read_file(folder.path() / "c.bag"));
}

TEST(IndependentRecording, IsReadBackWithItsRatesMountsAndTruth) {
  const TemporaryFolder folder;
  const RecordingOptions options = short_options();
  const fs::path bag = folder.path() / "short.bag";
  ASSERT_TRUE(write_recording(options, bag));
  auto reader = RecordingReader::open(bag, {});
  ASSERT_TRUE(reader) << reader.error().message;
  EXPECT_TRUE(reader->setup().has_legs);
  EXPECT_NEAR(*reader->setup().imu_rate_hz, 100.0, 0.1);
  EXPECT_LT(
      (reader->setup().rig.T_body_lidar.translation - rig_of(options).T_body_lidar.translation)
          .norm(),
      1e-9);
  std::vector<Delivery> deliveries;
  while (*reader->advance(kSecond, deliveries)) {
  }
  std::size_t scans = 0;
  for (const Delivery& each : deliveries) {
    if (const auto* scan = std::get_if<LidarScanPtr>(&each.measurement)) {
      ++scans;
      EXPECT_GT((*scan)->points.size(), 25000u);
    }
  }
  const auto truth = read_tum(folder.path() / "short.truth.tum");
  ASSERT_TRUE(truth);
  EXPECT_EQ(reader->truth().size(), truth->size());
  EXPECT_EQ(scans, static_cast<std::size_t>(truth->back().stamp / (kSecond / 10)));
  const auto times =
      parse_waypoint_times(*read_file(folder.path() / "short.waypoint_times.csv"), "times");
  ASSERT_TRUE(times);
  ASSERT_EQ(times->size(), 3u);
  EXPECT_NEAR(pose_at(*truth, (*times)[1].stamp)->translation.x(), 2.0, 1e-3);
}

/// Points of the scans of a recording, one after the other.
std::vector<LidarPoint> points_of(const fs::path& bag) {
  auto reader = RecordingReader::open(bag, {});
  std::vector<Delivery> deliveries;
  while (reader && *reader->advance(kSecond, deliveries)) {
  }
  std::vector<LidarPoint> points;
  for (const Delivery& each : deliveries) {
    if (const auto* scan = std::get_if<LidarScanPtr>(&each.measurement)) {
      points.insert(points.end(), (*scan)->points.begin(), (*scan)->points.end());
    }
  }
  return points;
}

TEST(IndependentRecording, ReliefMovesReturnsAndLeavesTheRestWithItsNoise) {
  const TemporaryFolder folder;
  RecordingOptions options = short_options();
  options.cell = "plain_open_30";
  options.outliers = 0.0;
  ASSERT_TRUE(write_recording(options, folder.path() / "plain.bag"));
  options.relief = 0.0015;
  ASSERT_TRUE(write_recording(options, folder.path() / "relief.bag"));
  EXPECT_TRUE(*read_file(folder.path() / "plain.truth.tum") ==
              *read_file(folder.path() / "relief.truth.tum"));
  const std::vector<LidarPoint> plain = points_of(folder.path() / "plain.bag");
  const std::vector<LidarPoint> relief = points_of(folder.path() / "relief.bag");
  double squares = 0.0;
  int count = 0;
  for (std::size_t i = 0; i < std::min(plain.size(), relief.size()); ++i) {
    // Until the first that only one of them has, at the end of the range.
    if (plain[i].ring != relief[i].ring || plain[i].time_offset_ns != relief[i].time_offset_ns)
      break;
    squares += (plain[i].position - relief[i].position).squaredNorm();
    ++count;
  }
  EXPECT_GT(count, 1000);
  EXPECT_GT(std::sqrt(squares / count), 0.0015);  // along rays that meet the wall aslant
  EXPECT_LT(std::sqrt(squares / count), 0.02);
}

TEST(IndependentRecording, BadOptionsAreErrors) {
  const TemporaryFolder folder;
  RecordingOptions options = short_options();
  options.length = 0.5;
  EXPECT_FALSE(write_recording(options, folder.path() / "x.bag"));
  options = short_options();
  options.rings = "64";
  EXPECT_FALSE(write_recording(options, folder.path() / "x.bag"));
  options = short_options();
  options.outliers = 2.0;
  EXPECT_FALSE(write_recording(options, folder.path() / "x.bag"));
  options = short_options();
  options.relief = -0.001;
  EXPECT_FALSE(write_recording(options, folder.path() / "x.bag"));
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

}  // namespace
}  // namespace aims::independent
