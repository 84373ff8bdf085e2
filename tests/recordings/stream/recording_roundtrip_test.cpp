// SPDX-License-Identifier: BSD-3-Clause
// What was recorded comes back bit for bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>

#include "recordings/stream/recording_reader.hpp"
#include "recordings/stream/recording_writer.hpp"
#include "tests/recordings/stream/recorded_deliveries.hpp"
#include "tests/recordings/stream/split_recording.hpp"
#include "tests/support/kinematic_world.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

/// Point times as float32 seconds hold them, as the simulated LiDAR gives them.
LidarScanPtr with_recordable_times(const LidarScanPtr& scan) {
  auto result = std::make_shared<LidarScan>(*scan);
  for (LidarPoint& point : result->points) {
    const auto seconds = static_cast<float>(point.time_offset_ns * 1e-9);
    point.time_offset_ns = static_cast<std::int32_t>(std::llround(double{seconds} * 1e9));
  }
  return result;
}

/// Three seconds of a walk, with encoders and contacts that the kinematic world leaves empty.
std::vector<Delivery> walk(test::KinematicWorld& world) {
  std::vector<Delivery> deliveries;
  world.advance(3 * kSecond, deliveries);
  RandomStream random(7, "test");
  for (Delivery& each : deliveries) {
    if (auto* scan = std::get_if<LidarScanPtr>(&each.measurement)) {
      *scan = with_recordable_times(*scan);
    } else if (auto* legs = std::get_if<LegOdometrySample>(&each.measurement)) {
      for (bool& stands : legs->contact) stands = random.chance(0.5);
      if (random.chance(0.9)) {
        legs->contact_force.emplace();
        for (double& force : *legs->contact_force) force = 100.0 * random.normal();
      }
      for (double& angle : legs->joint_position) angle = random.normal();
      for (double& rate : legs->joint_velocity) rate = random.normal();
    }
  }
  return deliveries;
}

test::KinematicConfig small_world() {
  test::KinematicConfig config;
  config.sensors.lidar_columns = 180;
  config.walk.distance = 2.0;
  return config;
}

void record(const std::filesystem::path& bag, const SensorRig& rig,
            const std::vector<Delivery>& deliveries, Time truth_until = kSecond) {
  auto writer = RecordingWriter::create(bag, rig, "seed: 1");
  ASSERT_TRUE(writer) << writer.error().message;
  for (const Delivery& each : deliveries) {
    Result<void> ok;
    if (const auto* imu = std::get_if<ImuSample>(&each.measurement)) {
      ok = writer->write_imu(ImuOutput::kMain, each.arrival, *imu);
      if (ok) ok = writer->write_imu(ImuOutput::kFast, each.arrival, *imu);
    } else if (const auto* legs = std::get_if<LegOdometrySample>(&each.measurement)) {
      ok = writer->write_legs(each.arrival, *legs);
    } else {
      ok = writer->write_scan(each.arrival, *std::get<LidarScanPtr>(each.measurement));
    }
    ASSERT_TRUE(ok) << ok.error().message;
  }
  for (Time stamp = 0; stamp < truth_until; stamp += 100 * kMillisecond) {
    BodyMotion motion;
    motion.stamp = stamp;
    motion.T_world_body.translation.x() = to_seconds(stamp);
    ASSERT_TRUE(writer->write_truth(motion));
  }
  ASSERT_TRUE(writer->close());
}

class RecordingRoundTrip : public ::testing::Test {
 protected:
  /// Writes, reads, and holds one against the other. `change`: of what is delivered.
  void expect_the_same(const std::function<void(std::vector<Delivery>&)>& change) {
    test::KinematicWorld world(small_world());
    std::vector<Delivery> written = walk(world);
    change(written);
    const std::filesystem::path bag = folder_.path() / "walk.bag";
    record(bag, world.rig(), written);
    if (HasFatalFailure()) return;
    auto reader = RecordingReader::open(bag, {});
    ASSERT_TRUE(reader) << reader.error().message;
    const auto read = test::read_all(*reader);
    ASSERT_TRUE(read) << read.error().message;
    test::expect_same_deliveries(written, *read);
    test::expect_same_pose(world.rig().T_body_lidar, reader->setup().rig.T_body_lidar);
    test::expect_same_pose(world.rig().T_body_base, reader->setup().rig.T_body_base);
    notes_ = reader->setup().notes;
    setup_ = reader->setup();
    truth_ = reader->truth();
    counts_ = reader->counts();
  }

  TemporaryFolder folder_;
  std::vector<std::string> notes_;
  RecordingSetup setup_;
  Trajectory truth_;
  std::map<std::string, int> counts_;
};

TEST_F(RecordingRoundTrip, ASequenceIsReadBackBitForBit) {
  expect_the_same([](auto&) {});
  EXPECT_EQ(notes_, std::vector<std::string>(
                        {"point time: field 'time' in s, relative to the cloud's stamp"}));
  EXPECT_EQ(setup_.topics.imu, "/imu/data");
  EXPECT_EQ(setup_.topics.leg_odometry, "/leg_odometry");
  EXPECT_TRUE(setup_.has_legs);
  EXPECT_TRUE(setup_.has_joints);
  EXPECT_NEAR(setup_.imu_rate_hz.value_or(0.0), 50.0, 1e-9);
  EXPECT_NEAR(setup_.leg_rate_hz.value_or(0.0), 200.0, 1e-9);
  EXPECT_TRUE(counts_.empty()) << counts_.begin()->first;
}

/// The walk in one bag, and in three formats by topic.
class SplitRecording : public RecordingRoundTrip {
 protected:
  void SetUp() override {
    test::KinematicWorld world(small_world());
    record(whole_, world.rig(), walk(world));
    test::split_recording(whole_, {{lidar_, RecordingFormat::kBag, {"/lidar/points"}},
                                   {imu_, RecordingFormat::kMcap, {"/imu/data"}},
                                   {rest_, RecordingFormat::kRosbag2, {}}});
  }
  void expect_the_whole(const std::filesystem::path& first, const BagOpenOptions& options) const {
    auto expected = RecordingReader::open(whole_, {});
    auto actual = RecordingReader::open(first, {}, options);
    ASSERT_TRUE(expected) << expected.error().message;
    ASSERT_TRUE(actual) << actual.error().message;
    auto wanted = test::read_all(*expected);
    auto read = test::read_all(*actual);
    ASSERT_TRUE(wanted && read);
    // Of equal record times the order is that of the file, or of the files.
    const auto order = [](const Delivery& each) {
      return std::pair(each.arrival, each.measurement.index());
    };
    std::ranges::stable_sort(*wanted, {}, order);
    std::ranges::stable_sort(*read, {}, order);
    test::expect_same_deliveries(*wanted, *read);
    EXPECT_EQ(actual->setup().notes, expected->setup().notes);
    EXPECT_EQ(actual->truth().size(), expected->truth().size());
    EXPECT_EQ(actual->summary().messages, expected->summary().messages);
    EXPECT_EQ(actual->summary().start, expected->summary().start);
    EXPECT_EQ(actual->summary().end, expected->summary().end);
  }

  std::filesystem::path whole_ = folder_.path() / "whole.bag";
  TemporaryFolder parts_;
  std::filesystem::path lidar_ = parts_.path() / "a_lidar.bag";
  std::filesystem::path imu_ = parts_.path() / "b_imu.mcap";
  std::filesystem::path rest_ = parts_.path() / "c_rest";
};

TEST_F(SplitRecording, FilesOfThreeFormatsAreOneRecording) {
  expect_the_whole(lidar_, {.with = {imu_, rest_}});
  expect_the_whole(rest_, {.with = {lidar_, imu_}});
}

TEST_F(SplitRecording, AFolderOfRecordingsIsOneRecording) { expect_the_whole(parts_.path(), {}); }

TEST_F(SplitRecording, AMessageThatTwoFilesHoldCountsOnce) {
  auto whole = RecordingReader::open(whole_, {});
  auto reader = RecordingReader::open(whole_, {}, {.with = {lidar_}});
  ASSERT_TRUE(whole && reader) << reader.error().message;
  const auto read = test::read_all(*reader);
  const auto expected = test::read_all(*whole);
  ASSERT_TRUE(read && expected) << read.error().message;
  test::expect_same_deliveries(*expected, *read);
  const auto scans = test::scans_of(*read).size();
  EXPECT_EQ(reader->counts().at("recorded_in_two_files"), static_cast<int>(scans));
}

TEST_F(SplitRecording, AFileNamedTwiceIsRefused) {
  const auto again = open_recording(lidar_, {.with = {imu_, lidar_}});
  ASSERT_FALSE(again);
  EXPECT_NE(again.error().message.find("a_lidar.bag: named twice"), std::string::npos);
}

TEST_F(RecordingRoundTrip, TheTruthMovesNoArrival) {
  test::KinematicWorld world(small_world());
  std::vector<Delivery> written = walk(world);
  for (Delivery& each : written) {
    // The recorder's clock leaps forward by 8 s.
    if (each.arrival > 2 * kSecond) each.arrival += 8 * kSecond;
  }
  const std::filesystem::path bag = folder_.path() / "walk.bag";
  record(bag, world.rig(), written, 11 * kSecond);
  RecordingConfig without;
  without.topics.truth = "none";
  auto with_truth = RecordingReader::open(bag, {});
  auto without_truth = RecordingReader::open(bag, without);
  ASSERT_TRUE(with_truth && without_truth);
  const auto expected = test::read_all(*without_truth);
  const auto read = test::read_all(*with_truth);
  ASSERT_TRUE(expected && read);
  test::expect_same_deliveries(*expected, *read);
  EXPECT_EQ(with_truth->truth().size(), 110U);
}

TEST_F(RecordingRoundTrip, TruthIsReadAndNotDelivered) {
  expect_the_same([](auto&) {});
  ASSERT_EQ(truth_.size(), 10U);
  EXPECT_EQ(truth_[3].stamp, 300 * kMillisecond);
  EXPECT_EQ(truth_[3].pose.translation.x(), to_seconds(300 * kMillisecond));
}

/// Gives every IMU sample an orientation made by `change`.
void orient(std::vector<Delivery>& deliveries,
            const std::function<std::optional<Eigen::Quaterniond>(int)>& change) {
  int index = 0;
  for (Delivery& each : deliveries) {
    if (auto* imu = std::get_if<ImuSample>(&each.measurement)) imu->orientation = change(index++);
  }
}

TEST_F(RecordingRoundTrip, AnOrientationOfTheImuIsReadBackWhereItHasOne) {
  expect_the_same([](std::vector<Delivery>& deliveries) {
    orient(deliveries, [](int i) -> std::optional<Eigen::Quaterniond> {
      if (i % 3 == 0) return std::nullopt;
      return so3_exp({0.01 * i, -0.2, 0.5});
    });
  });
  EXPECT_TRUE(counts_.empty()) << counts_.begin()->first;
}

TEST_F(RecordingRoundTrip, AnOrientationThatIsNoRotationIsLeftOutAndCounted) {
  test::KinematicWorld world(small_world());
  std::vector<Delivery> deliveries = walk(world);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  orient(deliveries, [&](int i) {
    return i % 2 == 0 ? Eigen::Quaterniond(0.0, 0.0, 0.0, 0.0)
                      : Eigen::Quaterniond(nan, 0.0, 0.0, 0.0);
  });
  record(folder_.path() / "walk.bag", world.rig(), deliveries);
  auto reader = RecordingReader::open(folder_.path() / "walk.bag", {});
  ASSERT_TRUE(reader) << reader.error().message;
  const auto read = test::read_all(*reader);
  ASSERT_TRUE(read) << read.error().message;
  int samples = 0;
  for (const Delivery& each : *read) {
    if (const auto* imu = std::get_if<ImuSample>(&each.measurement)) {
      EXPECT_FALSE(imu->orientation);
      ++samples;
    }
  }
  EXPECT_GT(samples, 100);
  EXPECT_EQ(reader->counts().at("imu_orientation_invalid"), samples);
}

TEST_F(RecordingRoundTrip, LostCloudsDoNotLengthenTheScan) {
  expect_the_same([](std::vector<Delivery>& deliveries) {
    RandomStream random(11, "test");
    std::erase_if(deliveries, [&](const Delivery& each) {
      return std::holds_alternative<LidarScanPtr>(each.measurement) && random.chance(0.7);
    });
  });
}

TEST_F(RecordingRoundTrip, StampErrorsDuplicatesAndLateArrivalsArePreserved) {
  expect_the_same([](std::vector<Delivery>& deliveries) {
    RandomStream random(12, "test");
    std::vector<Delivery> sent;
    for (Delivery& each : deliveries) {
      if (random.chance(0.05)) sent.push_back(each);
      if (auto* legs = std::get_if<LegOdometrySample>(&each.measurement)) {
        legs->stamp += std::llround(random.uniform(0.0, 4e6));
      } else if (auto* scan = std::get_if<LidarScanPtr>(&each.measurement)) {
        const Duration late = std::llround(random.uniform(-3e6, 3e6));
        auto moved = std::make_shared<LidarScan>(**scan);
        if (moved->stamp + late < 0) continue;
        moved->stamp += late;
        moved->end += late;
        *scan = moved;
      }
      each.arrival += std::llround(random.uniform(0.0, 3e7));
      sent.push_back(each);
    }
    std::stable_sort(sent.begin(), sent.end(),
                     [](const Delivery& a, const Delivery& b) { return a.arrival < b.arrival; });
    deliveries = std::move(sent);
  });
  EXPECT_GT(counts_["legs_stamp_not_increasing"], 0);
}

TEST_F(RecordingRoundTrip, AnEmptyScanIsDeliveredAndCounted) {
  expect_the_same([](std::vector<Delivery>& deliveries) {
    int scans = 0;
    for (Delivery& each : deliveries) {
      auto* scan = std::get_if<LidarScanPtr>(&each.measurement);
      if (scan == nullptr || ++scans != 5) continue;
      auto empty = std::make_shared<LidarScan>(**scan);
      empty->points.clear();
      *scan = empty;
    }
  });
  EXPECT_EQ(counts_, (std::map<std::string, int>{{"cloud_empty", 1}}));
}

TEST_F(RecordingRoundTrip, SpansOfAnyLengthGiveTheSameStream) {
  test::KinematicWorld world(small_world());
  const std::vector<Delivery> written = walk(world);
  const std::filesystem::path bag = folder_.path() / "walk.bag";
  record(bag, world.rig(), written);
  for (const Duration span : {Duration{1}, 7 * kMillisecond, 100 * kSecond}) {
    auto reader = RecordingReader::open(bag, {});
    ASSERT_TRUE(reader) << reader.error().message;
    const auto read = test::read_all(*reader, span);
    ASSERT_TRUE(read) << read.error().message;
    test::expect_same_deliveries(written, *read);
  }
}

TEST_F(RecordingRoundTrip, DelaysAreSubtractedFromStampsAlone) {
  test::KinematicWorld world(small_world());
  std::vector<Delivery> written = walk(world);
  const std::filesystem::path bag = folder_.path() / "walk.bag";
  record(bag, world.rig(), written);
  RecordingConfig config;
  config.imu_delay = 0.01;
  config.lidar_delay = -0.014;
  config.leg_delay = 0.005;
  for (Delivery& each : written) {
    if (auto* imu = std::get_if<ImuSample>(&each.measurement)) {
      imu->stamp -= 10 * kMillisecond;
    } else if (auto* legs = std::get_if<LegOdometrySample>(&each.measurement)) {
      legs->stamp -= 5 * kMillisecond;
    } else {
      auto& scan = std::get<LidarScanPtr>(each.measurement);
      auto moved = std::make_shared<LidarScan>(*scan);
      moved->stamp += 14 * kMillisecond;
      moved->end += 14 * kMillisecond;
      scan = moved;
    }
  }
  auto reader = RecordingReader::open(bag, config);
  ASSERT_TRUE(reader) << reader.error().message;
  const auto read = test::read_all(*reader);
  ASSERT_TRUE(read);
  test::expect_same_deliveries(written, *read);
}

/// Else estimators, which sort what arrives within 50 ms, would drop every scan as late.
TEST_F(RecordingRoundTrip, ArrivalsMoveWithStampsThatMoveFar) {
  test::KinematicWorld world(small_world());
  std::vector<Delivery> written = walk(world);
  const std::filesystem::path bag = folder_.path() / "walk.bag";
  record(bag, world.rig(), written);
  RecordingConfig config;
  config.lidar_delay = 0.2;
  for (Delivery& each : written) {
    auto* scan = std::get_if<LidarScanPtr>(&each.measurement);
    if (scan == nullptr) continue;
    auto moved = std::make_shared<LidarScan>(**scan);
    moved->stamp -= 200 * kMillisecond;
    moved->end -= 200 * kMillisecond;
    *scan = moved;
    each.arrival -= 200 * kMillisecond;
  }
  std::ranges::stable_sort(written, {}, &Delivery::arrival);
  auto reader = RecordingReader::open(bag, config);
  ASSERT_TRUE(reader) << reader.error().message;
  const auto read = test::read_all(*reader);
  ASSERT_TRUE(read);
  test::expect_same_deliveries(written, *read);
}

}  // namespace
}  // namespace aims
