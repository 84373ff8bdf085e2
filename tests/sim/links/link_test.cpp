// SPDX-License-Identifier: BSD-3-Clause
#include "sim/links/link.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <variant>

namespace aims {
namespace {

constexpr std::uint64_t kSeed = 7;
constexpr Duration kPeriod = 5 * kMillisecond;

/// Deliveries of `count` inertial samples sent every 5 ms, stamped with their sending.
std::vector<Delivery> send_samples(const LinkConfig& config, int count,
                                   std::uint64_t seed = kSeed) {
  Link link(config, seed, "imu");
  std::vector<Delivery> deliveries;
  for (int i = 0; i < count; ++i) {
    ImuSample sample;
    sample.stamp = i * kPeriod;
    link.send(sample.stamp, sample, deliveries);
  }
  return deliveries;
}

/// Whether each of `count` packets arrived, by the stamp of its sample.
std::vector<bool> arrived(const std::vector<Delivery>& deliveries, int count) {
  std::vector<bool> present(count, false);
  for (const Delivery& each : deliveries) present[stamp_of(each.measurement) / kPeriod] = true;
  return present;
}

/// Lengths of the runs of lost packets.
std::vector<int> bursts(const std::vector<bool>& present) {
  std::vector<int> lengths;
  int length = 0;
  for (const bool here : present) {
    if (!here) ++length;
    if (here && length > 0) lengths.push_back(std::exchange(length, 0));
  }
  return lengths;
}

double lost_share(const std::vector<bool>& present) {
  return static_cast<double>(std::count(present.begin(), present.end(), false)) /
         static_cast<double>(present.size());
}

TEST(Link, WithDefaultConfigurationChangesNothing) {
  Link link(LinkConfig{}, kSeed, "lidar");
  const auto scan = std::make_shared<LidarScan>(LidarScan{.stamp = 100, .end = 200, .points = {}});
  std::vector<Delivery> deliveries;
  for (int i = 0; i < 1000; ++i) {
    deliveries.clear();
    link.send(i, LidarScanPtr(scan), deliveries);
    ASSERT_EQ(deliveries.size(), 1U);
    EXPECT_EQ(deliveries[0].arrival, i);
    EXPECT_EQ(std::get<LidarScanPtr>(deliveries[0].measurement), scan);
  }
}

TEST(Link, LosesTheConfiguredFractionIndependently) {
  constexpr int kCount = 100'000;
  LinkConfig config;
  config.loss = 0.05;
  const auto present = arrived(send_samples(config, kCount), kCount);
  const double sigma = std::sqrt(0.05 * 0.95 / kCount);
  EXPECT_NEAR(lost_share(present), 0.05, 4.0 * sigma);
  const auto lengths = bursts(present);
  const double mean_length = lost_share(present) * kCount / static_cast<double>(lengths.size());
  EXPECT_NEAR(mean_length, 1.0 / 0.95, 0.02);
}

TEST(Link, LosesBurstsOfTheConfiguredLengthAndFraction) {
  constexpr int kCount = 400'000;
  LinkConfig config;
  config.burst_fraction = 0.08;
  config.burst_length = 12.0;
  const auto present = arrived(send_samples(config, kCount), kCount);
  const auto lengths = bursts(present);
  const double n = static_cast<double>(lengths.size());
  double sum = 0.0;
  double squares = 0.0;
  for (const int length : lengths) {
    sum += length;
    squares += static_cast<double>(length) * length;
  }
  const double mean = sum / n;
  // Geometric lengths: variance L (L - 1); the share's error follows from the count of bursts.
  const double sigma = std::sqrt(12.0 * 11.0 / n);
  EXPECT_NEAR(mean, 12.0, 4.0 * sigma);
  EXPECT_NEAR(squares / n - mean * mean, 12.0 * 11.0, 0.15 * 12.0 * 11.0);
  EXPECT_NEAR(lost_share(present), 0.08, 4.0 * 0.08 * std::sqrt(2.0 / n));
}

TEST(Link, DelaysEveryPacketAndSpreadsTheJitter) {
  LinkConfig config;
  config.delay = 0.02;
  config.jitter = 0.004;
  const auto deliveries = send_samples(config, 20'000);
  ASSERT_EQ(deliveries.size(), 20'000U);
  double sum = 0.0;
  for (const Delivery& each : deliveries) {
    const double late = to_seconds(each.arrival - stamp_of(each.measurement));
    ASSERT_GE(late, 0.02);
    ASSERT_LE(late, 0.024);
    sum += late;
  }
  EXPECT_NEAR(sum / 20'000.0, 0.022, 4.0 * 0.004 / std::sqrt(12.0 * 20'000.0));
}

TEST(Link, KeepsTheOrderUnlessPacketsAreHeldBack) {
  LinkConfig config;
  config.delay = 0.01;
  config.jitter = 0.004;  // less than the period
  const auto by_arrival = [](const Delivery& a, const Delivery& b) {
    return a.arrival < b.arrival;
  };
  auto deliveries = send_samples(config, 5000);
  EXPECT_TRUE(std::is_sorted(deliveries.begin(), deliveries.end(), by_arrival));

  config.jitter = 0.0;
  config.reorder_probability = 0.1;
  config.reorder_delay = 0.012;
  deliveries = send_samples(config, 5000);
  std::stable_sort(deliveries.begin(), deliveries.end(), by_arrival);
  int overtaken = 0;
  Time newest = -1;
  for (const Delivery& each : deliveries) {
    if (stamp_of(each.measurement) < newest) ++overtaken;
    newest = std::max(newest, stamp_of(each.measurement));
  }
  // A packet held back for 2.4 periods is overtaken unless the next two are held back too.
  const double expected = 5000.0 * 0.1 * (1.0 - 0.01);
  EXPECT_NEAR(overtaken, expected, 4.0 * std::sqrt(expected));
}

TEST(Link, DuplicatesTheConfiguredFractionWithTheSameContent) {
  LinkConfig config;
  config.duplicate_probability = 0.2;
  config.jitter = 0.003;
  std::map<Time, std::vector<Time>> arrivals;
  for (const Delivery& each : send_samples(config, 20'000)) {
    arrivals[stamp_of(each.measurement)].push_back(each.arrival);
  }
  ASSERT_EQ(arrivals.size(), 20'000U);
  int twice = 0;
  for (const auto& [stamp, times] : arrivals) {
    ASSERT_LE(times.size(), 2U);
    if (times.size() == 2) {
      ++twice;
      EXPECT_GE(times[1], times[0]);
    }
  }
  EXPECT_NEAR(twice, 4000.0, 4.0 * std::sqrt(20'000 * 0.2 * 0.8));
}

TEST(Link, ClockOffsetShiftsEveryStampAndNoArrival) {
  LinkConfig config;
  config.clock_offset = -0.005;
  Link link(config, kSeed, "any");
  const auto scan = std::make_shared<LidarScan>(
      LidarScan{.stamp = kSecond, .end = kSecond + 100 * kMillisecond, .points = {{}, {}}});
  std::vector<Delivery> out;
  link.send(2 * kSecond, LidarScanPtr(scan), out);
  ImuSample imu;
  imu.stamp = kSecond;
  link.send(2 * kSecond, imu, out);
  LegOdometrySample leg;
  leg.stamp = kSecond;
  link.send(2 * kSecond, leg, out);
  const Time shifted = kSecond - 5 * kMillisecond;
  const auto& sent_scan = *std::get<LidarScanPtr>(out[0].measurement);
  EXPECT_EQ(sent_scan.stamp, shifted);
  EXPECT_EQ(sent_scan.end, shifted + 100 * kMillisecond);
  EXPECT_EQ(sent_scan.points.size(), 2U);
  EXPECT_EQ(scan->stamp, kSecond) << "the sensor's own scan is untouched";
  EXPECT_EQ(stamp_of(out[1].measurement), shifted);
  EXPECT_EQ(stamp_of(out[2].measurement), shifted);
  for (const Delivery& each : out) EXPECT_EQ(each.arrival, 2 * kSecond);
}

TEST(Link, DrawsAnOffsetAndADriftOfTheClockPerRun) {
  LinkConfig config;
  config.clock_offset = 0.01;
  config.clock_offset_sigma = 0.002;
  config.clock_drift_sigma = 20.0;
  constexpr int kRuns = 1000;
  const Time late = 1000 * kSecond;
  double offset_square = 0.0;
  double drift_square = 0.0;
  for (int seed = 1; seed <= kRuns; ++seed) {
    Link link(config, seed, "any");
    std::vector<Delivery> out;
    link.send(0, ImuSample{.stamp = 0}, out);
    link.send(late, ImuSample{.stamp = late}, out);
    const double begin = to_seconds(stamp_of(out[0].measurement));
    const double end = to_seconds(stamp_of(out[1].measurement) - late);
    offset_square += (begin - 0.01) * (begin - 0.01) / kRuns;
    drift_square += (end - begin) * (end - begin) / kRuns;
  }
  EXPECT_NEAR(std::sqrt(offset_square), 0.002, 0.0002);
  EXPECT_NEAR(std::sqrt(drift_square), 1000.0 * 20e-6, 0.1 * 0.02);
}

// A recording states the stamp of a scan and one period for all: their ends must follow from it.
TEST(Link, ScansOfADriftingClockAreEquallyLong) {
  LinkConfig config;
  config.clock_drift_sigma = 20.0;
  Link link(config, 3, "any");
  std::vector<Delivery> out;
  for (Time stamp = 0; stamp < 60 * kSecond; stamp += kSecond / 10) {
    auto scan = std::make_shared<LidarScan>();
    scan->stamp = stamp;
    scan->end = stamp + kSecond / 10;
    const Time sent = scan->end;
    link.send(sent, std::move(scan), out);
  }
  std::set<Duration> durations;
  for (const Delivery& each : out) {
    const LidarScan& scan = *std::get<LidarScanPtr>(each.measurement);
    durations.insert(scan.end - scan.stamp);
  }
  ASSERT_EQ(durations.size(), 1U);
  EXPECT_NE(*durations.begin(), kSecond / 10);
  EXPECT_NEAR(static_cast<double>(*durations.begin()), 1e8, 1e8 * 100e-6);
}

TEST(Link, LosesExactlyWhatIsSentInAnOutage) {
  LinkConfig config;
  config.outage = {.start = 0.5, .duration = 0.2, .period = 1.0};
  const auto present = arrived(send_samples(config, 600), 600);  // three seconds
  for (int i = 0; i < 600; ++i) {
    const int within = i % 200;
    EXPECT_EQ(present[i], within < 100 || within >= 140) << i;
  }
}

TEST(Link, AnOutageWithoutAPeriodComesOnce) {
  LinkConfig config;
  config.outage = {.start = 0.1, .duration = 0.05, .period = 0.0};
  EXPECT_EQ(bursts(arrived(send_samples(config, 600), 600)), std::vector<int>{10});
}

TEST(Link, StampJitterMovesStampsWithinItsBoundsAndNoArrival) {
  LinkConfig config;
  config.stamp_jitter = 0.002;
  double least = 0.0;
  double most = 0.0;
  double sum = 0.0;
  for (const Delivery& each : send_samples(config, 20'000)) {
    const double error = to_seconds(stamp_of(each.measurement) - each.arrival);
    least = std::min(least, error);
    most = std::max(most, error);
    sum += error;
  }
  EXPECT_NEAR(least, -0.002, 1e-5);
  EXPECT_NEAR(most, 0.002, 1e-5);
  EXPECT_NEAR(sum / 20'000.0, 0.0, 4.0 * 0.002 / std::sqrt(3.0 * 20'000.0));
}

TEST(Link, OneFaultDoesNotAffectTheOthers) {
  constexpr int kCount = 5000;
  LinkConfig config;
  config.loss = 0.1;
  config.burst_fraction = 0.1;
  const auto present = arrived(send_samples(config, kCount), kCount);
  config.jitter = 0.001;
  config.reorder_probability = 0.3;
  config.duplicate_probability = 0.3;
  EXPECT_EQ(arrived(send_samples(config, kCount), kCount), present);
  config.outage = {.start = 20.0, .duration = 1.0, .period = 0.0};
  const auto with_outage = arrived(send_samples(config, kCount), kCount);
  EXPECT_TRUE(std::equal(present.begin(), present.begin() + 4000, with_outage.begin()));
  EXPECT_TRUE(std::equal(present.begin() + 4200, present.end(), with_outage.begin() + 4200));
}

TEST(Link, RepeatsWithItsSeedAndOnlyWithIt) {
  LinkConfig config;
  config.loss = 0.1;
  config.jitter = 0.004;
  const auto times = [&](std::uint64_t seed) {
    std::vector<Time> arrivals;
    for (const Delivery& each : send_samples(config, 1000, seed)) arrivals.push_back(each.arrival);
    return arrivals;
  };
  EXPECT_EQ(times(1), times(1));
  EXPECT_NE(times(1), times(2));
}

TEST(LinkConfig, EveryParameterTakesItsOwnText) {
  LinkConfig config;
  const Fields fields = fields_of(config);
  EXPECT_EQ(fields.parameters().size(), 15U);
  for (const Parameter& each : fields.parameters()) EXPECT_TRUE(each.assign(each.text()));
}

}  // namespace
}  // namespace aims
