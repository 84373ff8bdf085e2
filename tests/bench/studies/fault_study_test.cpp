// SPDX-License-Identifier: BSD-3-Clause
#include "bench/studies/fault_study.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "bench/jobs/sequence_cache.hpp"
#include "core/files/atomic_file.hpp"
#include "tests/bench/studies/short_walk.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

Delivery imu_at(Time stamp) {
  ImuSample sample;
  sample.stamp = stamp;
  sample.specific_force = {0.0, 0.0, 9.81};
  return {stamp, sample};
}

/// What comes out of the fault for IMU samples at 10 Hz over 30 s; it lasts from 10 to 20 s.
std::vector<Delivery> through(const std::string& name) {
  const auto faults = stream_faults();
  const auto fault = std::ranges::find(faults, name, &StreamFault::name);
  EXPECT_NE(fault, faults.end()) << name;
  const FaultTransform transform = fault->make({10 * kSecond, 20 * kSecond}, 1);
  std::vector<Delivery> out;
  for (int i = 0; i < 300; ++i) transform(imu_at(i * 100 * kMillisecond), out);
  return out;
}

double force_at(const std::vector<Delivery>& deliveries, double seconds) {
  for (const Delivery& each : deliveries) {
    if (each.arrival >= from_seconds(seconds)) {
      return std::get<ImuSample>(each.measurement).specific_force.z();
    }
  }
  return 0.0;
}

TEST(StreamFaults, HaveNamesOfTheirOwn) {
  std::set<std::string> names;
  for (const StreamFault& fault : stream_faults()) {
    EXPECT_TRUE(names.insert(fault.name).second) << fault.name;
    EXPECT_FALSE(fault.meaning.empty());
  }
  EXPECT_GT(names.size(), 70U);
}

TEST(StreamFaults, HitTheirWindowAlone) {
  EXPECT_EQ(through("none").size(), 300U);
  EXPECT_EQ(through("imu.dead_10s").size(), 200U);
  EXPECT_EQ(through("imu.dead").size(), 100U);
  EXPECT_EQ(through("legs.dead").size(), 300U);
  EXPECT_EQ(through("all.twice").size(), 500U);
  const auto nan = through("imu.specific_force_nan");
  EXPECT_TRUE(std::isfinite(force_at(nan, 9.0)));
  EXPECT_TRUE(std::isnan(force_at(nan, 15.0)));
  EXPECT_TRUE(std::isfinite(force_at(nan, 21.0)));
}

TEST(StreamFaults, LoseAsManyAsTheySay) {
  const auto left = static_cast<double>(through("imu.loss_50").size());
  EXPECT_NEAR(left, 100.0 + 100.0, 30.0);
}

TEST(StreamFaults, ShiftStamps) {
  const auto jumped = through("imu.clock_+1s");
  EXPECT_EQ(stamp_of(jumped[50].measurement), jumped[50].arrival);
  EXPECT_EQ(stamp_of(jumped[250].measurement), jumped[250].arrival + kSecond);
  int ahead = 0;
  for (const Delivery& each : through("imu.stamp_+3s")) {
    ahead += stamp_of(each.measurement) > each.arrival ? 1 : 0;
  }
  EXPECT_EQ(ahead, 1);
}

class FaultStudy : public ::testing::Test {
 protected:
  FaultStudy() : cache_(folder_.path()) {
    scenario_.simulation.lidar.columns = 300;
    const auto made = cache_.make(scenario_, 1);
    EXPECT_TRUE(made) << made.error().message;
  }
  std::vector<FaultCase> study(std::vector<std::string> faults, int jobs = 1) const {
    const auto sequence =
        open_sequence(cache_.file_of(SequenceCache::id_of(scenario_, 1)), scenario_, 1);
    if (!sequence) {
      ADD_FAILURE() << sequence.error().message;
      return {};
    }
    const auto cases =
        fault_study(*sequence, scenario_, {{"aims_d", "leg"}, std::move(faults), 1, jobs},
                    [](std::size_t, std::size_t) { return true; });
    EXPECT_TRUE(cases) << cases.error().message;
    return cases.value_or(std::vector<FaultCase>());
  }

  TemporaryFolder folder_;
  SequenceCache cache_;
  Scenario scenario_ = test::short_walk();
};

TEST_F(FaultStudy, CallsAnUndisturbedSequenceHealthy) {
  const auto cases = study({"none"});
  ASSERT_EQ(cases.size(), 2U);
  for (const FaultCase& each : cases) {
    EXPECT_TRUE(each.success);
    EXPECT_EQ(each.worst, HealthState::kHealthy) << each.estimator << each.reasons;
  }
}

TEST_F(FaultStudy, NamesADeadSensorAndDoesNotDependOnTheThreads) {
  const auto cases = study({"legs.dead"}, 2);
  ASSERT_EQ(cases.size(), 2U);
  EXPECT_EQ(cases[0].estimator, "aims_d");
  EXPECT_EQ(cases[0].worst, HealthState::kDegraded);
  EXPECT_EQ(cases[0].reasons, "no leg odometry");
  EXPECT_EQ(cases[1].estimator, "leg");
  EXPECT_EQ(cases[1].worst, HealthState::kDegraded);  // too short for a failure
}

TEST_F(FaultStudy, RefusesAFaultThatDoesNotExist) {
  const auto sequence =
      open_sequence(cache_.file_of(SequenceCache::id_of(scenario_, 1)), scenario_, 1);
  ASSERT_TRUE(sequence) << sequence.error().message;
  const auto cases = fault_study(*sequence, scenario_, {{"leg"}, {"imu.fire"}, 1, 1},
                                 [](std::size_t, std::size_t) { return true; });
  ASSERT_FALSE(cases);
  EXPECT_NE(cases.error().message.find("imu.fire"), std::string::npos);
}

TEST(FaultTable, NamesFailuresAndCountsThoseThatNobodyNotices) {
  FaultCase fine;
  fine.fault = "none";
  fine.estimator = "mine";
  fine.success = fine.judged = true;
  fine.ate_m = 0.1;
  fine.worst = HealthState::kHealthy;
  FaultCase silent = fine;
  silent.fault = "imu.dead";
  silent.success = false;
  silent.silent = silent.partial = true;
  FaultCase ended = silent;
  ended.fault = "lidar.dead";
  ended.silent = false;
  ended.failure = "add_scan: ZeroDivisionError";
  const std::vector<FaultCase> cases = {fine, silent, ended};
  const TextTable table = fault_table(cases);
  EXPECT_EQ(table.rows[0][1], "0.10 healthy");
  EXPECT_EQ(table.rows[1][1], "SILENT 0.10 part healthy");
  EXPECT_EQ(table.rows[2][1], "failed with an error");
  const TemporaryFolder folder;
  ASSERT_TRUE(write_faults(cases, "walk seed 1", folder.path()));
  EXPECT_NE(read_file(folder.path() / "faults.md")->find("1 of 3 cases fail unnoticed (SILENT)"),
            std::string::npos);
  EXPECT_NE(read_file(folder.path() / "faults.csv")->find("imu.dead,mine,false,true,0.1"),
            std::string::npos)
      << *read_file(folder.path() / "faults.csv");
}

}  // namespace
}  // namespace aims
