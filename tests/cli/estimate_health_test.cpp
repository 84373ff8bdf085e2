// SPDX-License-Identifier: BSD-3-Clause
// `aims estimate` where sensors are missing or useless, run as a user would.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "core/files/atomic_file.hpp"
#include "recordings/stream/recording_reader.hpp"
#include "recordings/stream/recording_writer.hpp"
#include "tests/cli/command_line.hpp"

namespace aims {
namespace {

using testing::Outcome;

const std::string kWalkWithTurns =
    "scene: {corridor: {length: 10}}\n"
    "route: {stand_before: 2.5, points: [{name: a, x: 0, y: 0}, {name: b, x: 2, y: 0.4}, "
    "{name: c, x: 0, y: 0}]}\n"
    "lidar: {columns: 400}\n";

class EstimateHealth : public testing::CommandLine {
 protected:
  EstimateHealth() {
    const Outcome made =
        aims("simulate " + scenario(testing::kMetreWalk) + " --quiet --out walk.bag");
    EXPECT_EQ(made.exit_code, 0) << made.output;
  }

  std::size_t poses(const std::string& name) const {
    const std::string text = read_file(folder_.path() / "out" / (name + ".tum")).value();
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
  }

  /// NAME: walk.bag with changed samples of the IMU, and without a truth.
  void write_changed(
      const std::string& name, const std::function<void(ImuSample&)>& change,
      const std::function<bool(int)>& is_scan_kept = [](int) { return true; }) const {
    auto reader = RecordingReader::open(folder_.path() / "walk.bag", {});
    ASSERT_TRUE(reader) << reader.error().message;
    auto writer = RecordingWriter::create(folder_.path() / name, reader->setup().rig, "");
    ASSERT_TRUE(writer) << writer.error().message;
    std::vector<Delivery> deliveries;
    while (reader->advance(kSecond, deliveries).value_or(false)) {
    }
    int scans = 0;
    for (Delivery& each : deliveries) {
      if (auto* imu = std::get_if<ImuSample>(&each.measurement)) {
        change(*imu);
        ASSERT_TRUE(writer->write_imu(ImuOutput::kMain, each.arrival, *imu));
      } else if (const auto* legs = std::get_if<LegOdometrySample>(&each.measurement)) {
        ASSERT_TRUE(writer->write_legs(each.arrival, *legs));
      } else if (is_scan_kept(scans++)) {
        ASSERT_TRUE(writer->write_scan(each.arrival, *std::get<LidarScanPtr>(each.measurement)));
      }
    }
    ASSERT_TRUE(writer->close());
  }
};

TEST_F(EstimateHealth, WithoutALidarThereArePosesAndItIsSaid) {
  const Outcome outcome = aims(
      "estimate walk.bag --topics lidar=none --estimators aims_d,leg --no-pictures --no-page "
      "--quiet --out out");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_GT(poses("aims_d"), 5U);
  EXPECT_GT(poses("leg"), 5U);
  EXPECT_TRUE(holds(outcome, "health: aims_d: degraded")) << outcome.output;
  EXPECT_TRUE(holds(outcome, "no LiDAR scans")) << outcome.output;
}

TEST_F(EstimateHealth, HealthyWhileWrongIsSaid) {
  const Outcome outcome = aims(
      "estimate walk.bag --estimators aims_d --set scoring.max_error_offset=1e-6 "
      "--set scoring.max_error_per_path=1e-6 --no-pictures --no-page --quiet --out out");
  EXPECT_TRUE(holds(outcome, "s while wrong")) << outcome.output;
  EXPECT_NE(read_file(folder_.path() / "out" / "scores.json").value().find("healthy_while_wrong_s"),
            std::string::npos);
}

TEST_F(EstimateHealth, AnAssumedTransformIsAWarningAtTheEndAndInTheHealth) {
  const Outcome outcome = aims(
      "estimate walk.bag --estimators lio,leg --set recording.lidar_frame=nowhere --no-pictures "
      "--quiet --out out");
  const auto warned = outcome.output.find("warning: NO TRANSFORM from");
  ASSERT_NE(warned, std::string::npos) << outcome.output;
  EXPECT_GT(warned, outcome.output.find("estimator  ")) << "after the table";
  const std::string rows = read_file(folder_.path() / "out" / "lio.health.csv").value();
  EXPECT_EQ(rows.find(",healthy,"), std::string::npos) << rows;
  EXPECT_NE(rows.find("T_imu_lidar unknown"), std::string::npos) << rows;
  const std::string legs = read_file(folder_.path() / "out" / "leg.health.csv").value();
  EXPECT_EQ(legs.find("T_imu_lidar"), std::string::npos) << "it has no LiDAR" << legs;
  EXPECT_TRUE(holds(outcome, "page: out/page.html")) << outcome.output;
}

TEST_F(EstimateHealth, AGyroThatLidarOdometryContradictsIsAWarning) {
  const Outcome made =
      aims("simulate " + scenario(kWalkWithTurns) + " --quiet --overwrite --out walk.bag");
  ASSERT_EQ(made.exit_code, 0) << made.output;
  const std::pair<double, std::string> gyros[] = {
      {1.0, ""}, {-1.0, "z of the gyro has the wrong sign"}, {0.5, "z of the gyro measures 0."}};
  for (const auto& [scale, cause] : gyros) {
    std::filesystem::remove(folder_.path() / "changed.bag");
    write_changed("changed.bag", [scale](ImuSample& imu) { imu.angular_velocity *= scale; });
    const Outcome outcome = aims(
        "estimate changed.bag --estimators lio --no-pictures --no-page --quiet --overwrite --out "
        "out");
    const bool warned = holds(outcome, "warning: LiDAR odometry and gyro contradict each other");
    EXPECT_EQ(warned, scale != 1.0) << outcome.output;
    EXPECT_TRUE(holds(outcome, cause)) << outcome.output;
    const std::string json = read_file(folder_.path() / "out" / "estimate.json").value();
    EXPECT_NE(json.find(cause), std::string::npos) << "of which the page is made";
    EXPECT_EQ(holds(outcome, "(LiDAR odometry contradicts the gyro"), scale != 1.0);
  }
}

// LiDAR odometry, which knows no gyro, may lose the turn there.
TEST_F(EstimateHealth, CloudsThatAreMissingInATurnSayNothingOfTheGyro) {
  const Outcome made =
      aims("simulate " + scenario(kWalkWithTurns) + " --quiet --overwrite --out walk.bag");
  ASSERT_EQ(made.exit_code, 0) << made.output;
  write_changed(
      "changed.bag", [](ImuSample&) {}, [](int i) { return i % 7 < 2; });
  const Outcome outcome = aims(
      "estimate changed.bag --estimators lio --no-pictures --no-page --quiet --overwrite --out "
      "out");
  EXPECT_FALSE(holds(outcome, "LiDAR odometry and gyro contradict")) << outcome.output;
}

TEST_F(EstimateHealth, RangesThatLeaveMostReturnsOutAreAWarning) {
  const Outcome outcome = aims(
      "estimate walk.bag --estimators lio --set estimators.lio.lidar.max_range=1 --no-pictures "
      "--no-page --quiet --out out");
  EXPECT_TRUE(holds(outcome,
                    "lio: in 100 % of the scans more than half of the returns are farther than "
                    "lidar.max_range and left out"))
      << outcome.output;
  EXPECT_TRUE(holds(outcome, "most returns are out of range")) << "in the health" << outcome.output;
}

TEST_F(EstimateHealth, OfTooShortARecordingThatIsSaid) {
  const auto whole = folder_.path() / "walk.bag";
  auto reader = RecordingReader::open(whole, {});
  ASSERT_TRUE(reader) << reader.error().message;
  auto writer = RecordingWriter::create(folder_.path() / "short.bag", reader->setup().rig, "");
  ASSERT_TRUE(writer) << writer.error().message;
  std::vector<Delivery> deliveries;
  ASSERT_TRUE(reader->advance(kSecond / 2, deliveries));
  for (const Delivery& each : deliveries) {
    if (const auto* imu = std::get_if<ImuSample>(&each.measurement)) {
      ASSERT_TRUE(writer->write_imu(ImuOutput::kMain, each.arrival, *imu));
    } else if (const auto* scan = std::get_if<LidarScanPtr>(&each.measurement)) {
      ASSERT_TRUE(writer->write_scan(each.arrival, **scan));
    }
  }
  ASSERT_TRUE(writer->close());
  const Outcome outcome =
      aims("estimate short.bag --estimators lio --no-pictures --no-page --quiet --out out");
  EXPECT_TRUE(holds(outcome, "health: lio: too short: ")) << outcome.output;
  EXPECT_TRUE(holds(outcome, "warning: too short: ")) << outcome.output;
  EXPECT_FALSE(holds(outcome, "never started")) << outcome.output;
  EXPECT_TRUE(holds(aims("info short.bag"), "warning: too short: "));
}

TEST_F(EstimateHealth, AnEstimateWithoutPosesIsNoSuccess) {
  write_changed("useless.bag", [](ImuSample& imu) {
    imu.specific_force.setConstant(std::numeric_limits<double>::quiet_NaN());
  });
  const Outcome outcome =
      aims("estimate useless.bag --estimators aims --no-pictures --no-page --quiet --out out");
  EXPECT_EQ(outcome.exit_code, 4) << outcome.output;
  EXPECT_TRUE(holds(outcome, "aims: no poses")) << outcome.output;
  EXPECT_TRUE(holds(outcome, "no IMU data")) << outcome.output;
  const std::string health = read_file(folder_.path() / "out" / "aims.health.csv").value();
  EXPECT_NE(health.find("invalid"), std::string::npos) << health;
}

}  // namespace
}  // namespace aims
