// SPDX-License-Identifier: BSD-3-Clause
// Recordings in the layouts of the vendors' drivers: read without hints, they give back what was
// fired and delivered.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <map>
#include <string>
#include <utility>

#include "bench/run/record.hpp"
#include "bench/scenario/scenario.hpp"
#include "recordings/inspection/bag_info.hpp"
#include "recordings/messages/point_layout.hpp"
#include "recordings/stream/recording_reader.hpp"
#include "sim/sensors/scan_pattern.hpp"
#include "sim/simulation.hpp"
#include "tests/recordings/stream/recorded_deliveries.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

class LidarRecordings : public ::testing::TestWithParam<const char*> {
 protected:
  Scenario standing(const std::string& model) const {
    const auto file = folder_.path() / "s.yaml";
    std::ofstream(file) << "{sensors: ideal, scene: {corridor: {length: 10}}, route: {points: "
                           "[{name: a, x: 0, y: 0}, {name: b, x: 2, y: 0}]}, max_duration: 0.55}";
    const std::vector<std::string> settings = {"lidar.model=" + model};
    return load_scenario(file, settings).value();
  }
  TemporaryFolder folder_;
};

std::vector<LidarScanPtr> simulated_scans(const Scenario& scenario) {
  Simulation simulation = Simulation::create(scenario.simulation, 3).value();
  std::vector<Delivery> deliveries;
  while (simulation.advance(kSecond, deliveries)) {
  }
  return test::scans_of(deliveries);
}

/// The direction that was fired at a time, by (ns, ring).
std::map<std::pair<std::int32_t, int>, Eigen::Vector3f> fired(const LidarConfig& config,
                                                              std::int64_t scan) {
  std::map<std::pair<std::int32_t, int>, Eigen::Vector3f> directions;
  for (const Firing& firing : ScanPattern(config).firings(scan)) {
    const auto seconds = static_cast<float>(firing.time_offset_ns * 1e-9);
    directions[{static_cast<std::int32_t>(std::llround(double{seconds} * 1e9)), firing.ring}] =
        firing.beam.direction().cast<float>();
  }
  return directions;
}

TEST_P(LidarRecordings, GiveBackTheDirectionsAndTimesThatWereFired) {
  const Scenario scenario = standing(GetParam());
  const LidarConfig& lidar = scenario.simulation.lidar;
  const bool ros2 = GetParam() == std::string("vlp32c") || GetParam() == std::string("mid360");
  const RecordOptions options = {.seed = 3,
                                 .bag = folder_.path() / (ros2 ? "standing.mcap" : "standing.bag")};
  const auto recorded = record(scenario, options, [](const Progress&) { return true; });
  ASSERT_TRUE(recorded) << recorded.error().message;
  auto reader = RecordingReader::open(options.bag, {});
  ASSERT_TRUE(reader) << reader.error().message;
  const auto deliveries = test::read_all(*reader);
  ASSERT_TRUE(deliveries) << deliveries.error().message;
  const auto scans = test::scans_of(*deliveries);
  const auto wanted = simulated_scans(scenario);
  ASSERT_EQ(scans.size(), 5U);
  ASSERT_EQ(wanted.size(), 5U);
  for (std::size_t k = 0; k < scans.size(); ++k) {
    const LidarScan& scan = *scans[k];
    EXPECT_EQ(scan.stamp, wanted[k]->stamp);
    EXPECT_EQ(scan.end, wanted[k]->end);
    ASSERT_EQ(scan.points.size(), wanted[k]->points.size());
    const auto directions = fired(lidar, static_cast<std::int64_t>(k));
    for (std::size_t i = 0; i < scan.points.size(); ++i) {
      const LidarPoint& point = scan.points[i];
      const LidarPoint& expected = wanted[k]->points[i];
      ASSERT_EQ(point.position, expected.position) << k << ' ' << i;
      ASSERT_EQ(point.time_offset_ns, expected.time_offset_ns) << k << ' ' << i;
      ASSERT_EQ(point.ring, expected.ring) << k << ' ' << i;
      const auto beam = directions.find({point.time_offset_ns, point.ring});
      ASSERT_NE(beam, directions.end()) << point.time_offset_ns;
      ASSERT_LT((point.position.normalized() - beam->second).norm(), 1e-5F);
    }
  }
  const ScanPattern pattern(lidar);
  EXPECT_EQ(reader->setup().rings.count, pattern.has_rings() ? pattern.lines() : 0);
  EXPECT_TRUE(reader->setup().has_point_times);
  const auto info = bag_info(options.bag, {}, {});
  ASSERT_TRUE(info) << info.error().message;
  ASSERT_EQ(info->clouds.size(), 1U);
  EXPECT_EQ(info->clouds[0].driver, point_layout(lidar.layout).driver);
}

INSTANTIATE_TEST_SUITE_P(Models, LidarRecordings,
                         ::testing::Values("generic", "vlp16", "vlp32c", "os1_32", "os1_128",
                                           "xt32", "mid360"),
                         [](const auto& each) { return std::string(each.param); });

/// A number at a place of a point's bytes.
template <class Number>
Number at(const PointBlock& block, std::size_t byte) {
  Number value{};
  std::memcpy(&value, block.bytes.data() + byte, sizeof(value));
  return value;
}

/// Two returns of a sensor of two rings and four columns of 25 ms, the first at 100 s.
LidarScan two_returns() {
  LidarScan scan;
  scan.stamp = 100 * kSecond;
  scan.end = scan.stamp + 100 * kMillisecond;
  scan.points.push_back({{3.0F, 4.0F, 0.0F}, 0.5F, 0, 1});
  scan.points.push_back({{0.0F, 0.0F, -2.0F}, 1.0F, 75'000'000, 0});
  return scan;
}

CloudFormat format_of(CloudLayout layout) { return {layout, 2, 4, 25e6}; }

TEST(PointBlocks, OusterHasARowPerRingFromTheTopWithMissesAtTheOrigin) {
  const PointBlock block = point_block(two_returns(), format_of(CloudLayout::kOuster));
  ASSERT_EQ(block.height, 2U);
  ASSERT_EQ(block.width, 4U);
  ASSERT_EQ(block.bytes.size(), 8U * 48U);
  EXPECT_EQ(at<float>(block, 0), 3.0F);
  EXPECT_EQ(at<float>(block, 4), 4.0F);
  EXPECT_EQ(at<float>(block, 16), 127.5F);
  EXPECT_EQ(at<std::uint32_t>(block, 20), 0U);
  EXPECT_EQ(at<std::uint16_t>(block, 24), 128U);
  EXPECT_EQ(at<std::uint16_t>(block, 26), 0U) << "ring 0 is the highest";
  EXPECT_EQ(at<std::uint32_t>(block, 32), 5000U) << "mm";
  const std::size_t miss = 1 * 48;
  EXPECT_EQ(at<float>(block, miss), 0.0F);
  EXPECT_EQ(at<std::uint32_t>(block, miss + 20), 25'000'000U);
  EXPECT_EQ(at<std::uint32_t>(block, miss + 32), 0U);
  const std::size_t last = 7 * 48;
  EXPECT_EQ(at<float>(block, last + 8), -2.0F);
  EXPECT_EQ(at<std::uint16_t>(block, last + 26), 1U);
  EXPECT_EQ(at<std::uint32_t>(block, last + 20), 75'000'000U);
}

TEST(PointBlocks, HesaiHasAbsoluteSecondsAndVelodyneRelativeOnes) {
  const PointBlock hesai = point_block(two_returns(), format_of(CloudLayout::kHesai));
  ASSERT_EQ(hesai.bytes.size(), 2U * 26U);
  EXPECT_EQ(at<std::uint16_t>(hesai, 16), 0U);
  EXPECT_EQ(at<double>(hesai, 18), 100.0);
  EXPECT_EQ(at<std::uint16_t>(hesai, 26 + 16), 1U);
  EXPECT_EQ(at<double>(hesai, 26 + 18), 100.075);
  EXPECT_EQ(at<float>(hesai, 26 + 12), 255.0F);
  const PointBlock velodyne = point_block(two_returns(), format_of(CloudLayout::kVelodyne));
  ASSERT_EQ(velodyne.bytes.size(), 2U * 22U);
  EXPECT_EQ(at<float>(velodyne, 12), 50.0F);
  EXPECT_EQ(at<std::uint16_t>(velodyne, 16), 1U);
  EXPECT_EQ(at<float>(velodyne, 22 + 18), 0.075F);
}

TEST(PointBlocks, LivoxHoldsEveryFiringWithItsLine) {
  LidarScan scan = two_returns();
  scan.points[0].time_offset_ns = 12'500'000;  // the second firing
  scan.points[1].time_offset_ns = 75'000'000;
  const PointBlock block = point_block(scan, format_of(CloudLayout::kLivox));
  ASSERT_EQ(block.width, 8U);
  ASSERT_EQ(block.bytes.size(), 8U * 26U);
  EXPECT_EQ(at<float>(block, 0), 0.0F) << "a miss";
  EXPECT_EQ(at<double>(block, 18), 100e9);
  EXPECT_EQ(at<float>(block, 26), 3.0F);
  EXPECT_EQ(at<std::uint8_t>(block, 26 + 17), 1U);
  EXPECT_EQ(at<double>(block, 26 + 18), 100e9 + 12.5e6);
  EXPECT_EQ(at<float>(block, 6 * 26 + 8), -2.0F);
  EXPECT_EQ(at<double>(block, 6 * 26 + 18), 100e9 + 75e6);
}

}  // namespace
}  // namespace aims
