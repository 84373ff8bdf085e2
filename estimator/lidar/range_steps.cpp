// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/lidar/range_steps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace aims {
namespace {

/// Firings over which a line of inverse ranges is drawn.
constexpr int kBase = 3;
/// Deviation of the difference between a return and the line one firing ahead of it, in deviations
/// of a range: sqrt((4/3)^2 + (1/3)^2 + 1).
constexpr double kPredictionNoise = 1.6997;
/// Smaller steps, in deviations of that difference, may be noise: one in 10^5.
constexpr double kSignificant = 4.5;
/// Median of the magnitude of a normal variable, in its deviations.
constexpr double kMedianMagnitude = 0.6745;
/// Of this many returns, one measures the noise.
constexpr std::size_t kSampling = 5;
/// Firings of a ring farther apart in time than this many of its intervals have a gap between them.
constexpr double kGap = 1.5;

}  // namespace

void RangeSteps::mark(const LidarScan& scan) {
  mixed_.assign(scan.points.size(), 0);
  list_firings(scan);
  range_noise_ = measure_noise();
  for (const Ring& ring : rings_) mark_ring(ring);
}

void RangeSteps::list_firings(const LidarScan& scan) {
  for (Ring& ring : rings_) ring.clear();
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const LidarPoint& point = scan.points[i];
    const double range = point.position.norm();
    if (!(range > 0.0) || !std::isfinite(range)) continue;
    if (point.ring >= rings_.size()) rings_.resize(point.ring + 1U);
    rings_[point.ring].push_back({static_cast<std::int32_t>(i), 0, 1.0 / range});
  }
  for (Ring& ring : rings_) count_runs(scan, ring);
}

void RangeSteps::count_runs(const LidarScan& scan, Ring& ring) const {
  const auto interval = [&](std::size_t k) {
    const auto offset = [&](std::size_t j) {
      return scan.points[static_cast<std::size_t>(ring[j].index)].time_offset_ns;
    };
    return offset(k) - offset(k - 1);
  };
  std::int32_t shortest = std::numeric_limits<std::int32_t>::max();
  for (std::size_t k = 1; k < ring.size(); ++k) {
    if (interval(k) > 0) shortest = std::min(shortest, interval(k));
  }
  for (std::size_t k = 1; k < ring.size(); ++k) {
    const bool next = interval(k) > 0 && interval(k) < kGap * shortest;
    ring[k].run = next ? ring[k - 1].run + 1 : 0;
  }
}

/// The median over the returns: most lie on flat surfaces.
double RangeSteps::measure_noise() {
  deviations_.clear();
  for (const Ring& ring : rings_) {
    for (std::size_t k = kBase + 1; k < ring.size(); k += kSampling) {
      if (ring[k].run < kBase + 1) continue;
      const double before = ring[k - 1].inverse_range;
      const double slope = (before - ring[k - 1 - kBase].inverse_range) / kBase;
      const double here = ring[k].inverse_range;
      deviations_.push_back(std::abs(here - before - slope) / (here * here));
    }
  }
  if (deviations_.empty()) return 0.0;
  const auto middle = deviations_.begin() + static_cast<std::ptrdiff_t>(deviations_.size() / 2);
  std::nth_element(deviations_.begin(), middle, deviations_.end());
  return *middle / (kMedianMagnitude * kPredictionNoise);
}

bool RangeSteps::steps_between(const Ring& ring, int a, int b) const {
  const auto inverse_range = [&](int k) { return ring[static_cast<std::size_t>(k)].inverse_range; };
  const double u_a = inverse_range(a);
  const double u_b = inverse_range(b);
  const double slope_a = (u_a - inverse_range(a - kBase)) / kBase;
  const double slope_b = (inverse_range(b + kBase) - u_b) / kBase;
  const double past_a = u_b - (u_a + (b - a) * slope_a);
  const double past_b = u_a - (u_b - (b - a) * slope_b);
  if (past_a * past_b >= 0.0) return false;
  const double nearer = std::max(u_a, u_b);
  const double noise = kPredictionNoise * range_noise_ * nearer * nearer;  // of an inverse range
  return std::min(std::abs(past_a), std::abs(past_b)) > kSignificant * noise;
}

void RangeSteps::mark_ring(const Ring& ring) {
  const int count = static_cast<int>(ring.size());
  for (int a = kBase; a + 2 + kBase < count; ++a) {
    const bool whole = ring[static_cast<std::size_t>(a + 2 + kBase)].run >= 2 * kBase + 2;
    if (!whole || !steps_between(ring, a, a + 2)) continue;
    const auto between = static_cast<std::size_t>(ring[static_cast<std::size_t>(a + 1)].index);
    mixed_[between] = 1;
  }
}

}  // namespace aims
