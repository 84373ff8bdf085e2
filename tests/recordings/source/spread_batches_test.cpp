// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/source/spread_batches.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/random.hpp"

namespace aims {
namespace {

constexpr Duration kPeriod = 5 * kMillisecond;

/// When a sample was taken, and when it was recorded.
struct Recorded {
  Time taken = 0, recorded = 0;
};

/// Samples at a steady rate, so many at once; recorded with jitter, some lost.
std::vector<Recorded> batches(int samples, double jitter, double loss, std::uint64_t seed = 1) {
  RandomStream random(seed, "batches");
  std::vector<Recorded> all, batch;
  for (int k = 0; k < 4000; ++k) {
    const Time now = kSecond + k * kPeriod;
    if (random.uniform(0.0, 1.0) >= loss) batch.push_back({now, 0});
    if ((k + 1) % samples != 0) continue;
    const Time recorded = now + kMillisecond + from_seconds(jitter * random.uniform(0.0, 1.0));
    for (Recorded& each : batch) each.recorded = recorded;
    all.insert(all.end(), batch.begin(), batch.end());
    batch.clear();
  }
  return all;
}

std::vector<Time> record_times(const std::vector<Recorded>& all) {
  std::vector<Time> times;
  for (const Recorded& each : all) times.push_back(each.recorded);
  return times;
}

/// The largest deviation of the spread times from true ones and a constant delay [s].
double largest_error(const std::vector<Recorded>& all, double delay) {
  BatchClock clock(*batch_rate(record_times(all)));
  double largest = 0.0;
  for (std::size_t i = 0; i < all.size();) {
    std::size_t end = i;
    while (end < all.size() && all[end].recorded == all[i].recorded) ++end;
    const auto times = clock.add(all[i].recorded, end - i);
    for (std::size_t k = i; k < end; ++k) {
      EXPECT_LE(times[k - i], all[k].recorded) << "taken before it is recorded";
      EXPECT_GT(times[k - i], k > i ? times[k - i - 1] : 0);
      largest = std::max(largest, std::abs(to_seconds(times[k - i] - all[k].taken) - delay));
    }
    i = end;
  }
  return largest;
}

TEST(BatchRate, IsFoundForBatchesOfAnySize) {
  for (const int samples : {2, 3, 10, 40}) {
    const auto rate = batch_rate(record_times(batches(samples, 0.0, 0.0)));
    ASSERT_TRUE(rate) << samples;
    EXPECT_NEAR(rate->period, static_cast<double>(kPeriod), 1.0);
    EXPECT_NEAR(rate->samples, samples, 1e-9);
  }
}

TEST(BatchRate, IsNoneOfSamplesThatComeOneByOne) {
  EXPECT_FALSE(batch_rate(record_times(batches(1, 0.0, 0.0))));
  EXPECT_FALSE(batch_rate(record_times(batches(1, 0.004, 0.2))));
  EXPECT_FALSE(batch_rate({}));
}

TEST(BatchRate, IsNoneWhereTheNumbersOfSamplesDoNotGoWithTheTimes) {
  std::vector<Time> times;
  RandomStream random(3, "unsteady");
  Time now = kSecond;
  for (int batch = 0; batch < 100; ++batch) {
    now += from_seconds(random.uniform(0.01, 0.2));
    const int samples = 1 + static_cast<int>(random.uniform(0.0, 20.0));
    times.insert(times.end(), static_cast<std::size_t>(samples), now);
  }
  EXPECT_FALSE(batch_rate(times));
}

TEST(BatchClock, SteadyBatchesGetTheTimesAtWhichTheyWereTaken) {
  for (const int samples : {2, 10, 40}) {
    EXPECT_LT(largest_error(batches(samples, 0.0, 0.0), 0.001), 1e-5) << samples;
  }
}

TEST(BatchClock, JitterOfTheRecordTimesIsSmoothed) {
  // Record times are 0 to 10 ms late.
  EXPECT_LT(largest_error(batches(10, 0.01, 0.0), 0.001 + 0.003), 0.007);
}

TEST(BatchClock, LostSamplesShiftTheOthersByAFewPeriods) {
  EXPECT_LT(largest_error(batches(10, 0.0, 0.05), 0.001), 6 * to_seconds(kPeriod));
}

TEST(BatchClock, AGapIsPassed) {
  BatchClock clock({kMillisecond, static_cast<double>(kPeriod), 10.0});
  clock.add(kSecond, 10);
  const auto behind = clock.add(60 * kSecond, 10);
  EXPECT_EQ(behind.back(), 60 * kSecond);
  EXPECT_EQ(behind.front(), 60 * kSecond - 9 * kPeriod);
}

}  // namespace
}  // namespace aims
