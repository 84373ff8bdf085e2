// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/lidar/range_steps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace aims {
namespace {

/// Firings over which a line of inverse ranges is drawn.
constexpr std::size_t kBase = 3;
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
  for (const Ring& ring : rings_) count_runs(ring);
  range_noise_ = measure_noise();
  for (const Ring& ring : rings_) mark_ring(ring);
}

/// Sorts the returns by ring, in order of firing within each.
void RangeSteps::list_firings(const LidarScan& scan) {
  ring_ends_.clear();
  for (const LidarPoint& point : scan.points) {
    if (point.ring >= ring_ends_.size()) ring_ends_.resize(point.ring + 1U, 0);
    ++ring_ends_[point.ring];
  }
  ring_begins_.resize(ring_ends_.size());
  std::exclusive_scan(ring_ends_.begin(), ring_ends_.end(), ring_begins_.begin(), std::size_t{0});
  ring_ends_ = ring_begins_;
  firings_.resize(scan.points.size());
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const LidarPoint& point = scan.points[i];
    const double range = point.position.norm();
    if (!(range > 0.0) || !std::isfinite(range)) continue;
    firings_[ring_ends_[point.ring]++] = {.index = static_cast<std::int32_t>(i),
                                          .time_offset_ns = point.time_offset_ns,
                                          .inverse_range = 1.0 / range};
  }
  rings_.clear();
  for (std::size_t ring = 0; ring < ring_ends_.size(); ++ring) {
    rings_.emplace_back(firings_.data() + ring_begins_[ring], firings_.data() + ring_ends_[ring]);
  }
}

void RangeSteps::count_runs(const Ring& ring) {
  const auto interval = [&](std::size_t k) {
    return ring[k].time_offset_ns - ring[k - 1].time_offset_ns;
  };
  std::int32_t shortest = std::numeric_limits<std::int32_t>::max();
  for (std::size_t k = 1; k < ring.size(); ++k) {
    if (interval(k) > 0) shortest = std::min(shortest, interval(k));
  }
  for (std::size_t k = 1; k < ring.size(); ++k) {
    const bool next = interval(k) > 0 && interval(k) < kGap * shortest;
    ring[k].run = next ? ring[k - 1].run + 1 : 0;
  }
  for (std::size_t k = kBase; k < ring.size(); ++k) {
    ring[k].slope = (ring[k].inverse_range - ring[k - kBase].inverse_range) / kBase;
  }
}

/// The median over the returns: most lie on flat surfaces.
double RangeSteps::measure_noise() {
  deviations_.clear();
  for (const Ring& ring : rings_) {
    for (std::size_t k = kBase + 1; k < ring.size(); k += kSampling) {
      if (ring[k].run < static_cast<int>(kBase) + 1) continue;
      const double here = ring[k].inverse_range;
      const double past = here - ring[k - 1].inverse_range - ring[k - 1].slope;
      deviations_.push_back(std::abs(past) / (here * here));
    }
  }
  if (deviations_.empty()) return 0.0;
  const auto middle = deviations_.begin() + static_cast<std::ptrdiff_t>(deviations_.size() / 2);
  std::nth_element(deviations_.begin(), middle, deviations_.end());
  return *middle / (kMedianMagnitude * kPredictionNoise);
}

/// Whether there is a step between the firings `a` and `a + 2`.
bool RangeSteps::steps_after(const Ring& ring, std::size_t a) const {
  const std::size_t b = a + 2;
  const double u_a = ring[a].inverse_range;
  const double u_b = ring[b].inverse_range;
  const double past_a = u_b - (u_a + 2.0 * ring[a].slope);
  const double past_b = u_a - (u_b - 2.0 * ring[b + kBase].slope);
  if (past_a * past_b >= 0.0) return false;
  const double nearer = std::max(u_a, u_b);
  const double noise = kPredictionNoise * range_noise_ * nearer * nearer;  // of an inverse range
  return std::min(std::abs(past_a), std::abs(past_b)) > kSignificant * noise;
}

void RangeSteps::mark_ring(const Ring& ring) {
  for (std::size_t a = kBase; a + 2 + kBase < ring.size(); ++a) {
    const bool whole = ring[a + 2 + kBase].run >= static_cast<int>(2 * kBase + 2);
    if (whole && steps_after(ring, a)) mixed_[static_cast<std::size_t>(ring[a + 1].index)] = 1;
  }
}

}  // namespace aims
