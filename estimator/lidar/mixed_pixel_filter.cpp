// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/lidar/mixed_pixel_filter.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace aims {
namespace {

/// Firings over which a line of inverse ranges is drawn.
constexpr std::size_t kBase = 3;
/// Firings from the first of the line before a step to the last of the line after it.
constexpr std::size_t kSpan = 2 * kBase + 2;
/// Deviation of the difference between a return and the line one firing ahead of it, in deviations
/// of a range: sqrt((4/3)^2 + (1/3)^2 + 1).
constexpr double kPredictionNoise = 1.6997;
/// Smaller steps, in deviations of that difference, may be noise: one in 10^5.
constexpr double kSignificant = 4.5;
/// Median of the magnitude of a normal variable, in its deviations.
constexpr double kMedianMagnitude = 0.6745;
/// Of this many blocks of four returns, one measures the noise.
constexpr std::size_t kSampling = 7;
/// Blocks of firings and their lines reach beyond the last firing of a ring.
constexpr std::size_t kMargin = kSpan + 4;

/// The first lanes of a block of which only `left` have a firing.
unsigned first_lanes(std::size_t left) { return left < 4 ? (1U << left) - 1U : 15U; }

}  // namespace

void MixedPixelFilter::mark(const LidarScan& scan) {
  marked_.assign(scan.points.size(), 0);
  sort(scan);
  deviations_.clear();
  for (Ring& ring : rings_) {
    measure(ring);
    add_deviations(ring);
  }
  range_noise_ = measure_noise();
  for (const Ring& ring : rings_) mark_ring(ring);
}

/// Sorts the returns by ring, in order of firing within each.
void MixedPixelFilter::sort(const LidarScan& scan) {
  if (try_sort(scan)) return;
  make_room(scan);
  try_sort(scan);
}

/// Room for the returns of each ring of `scan`, and some more: later scans have as many or few.
void MixedPixelFilter::make_room(const LidarScan& scan) {
  for (Ring& ring : rings_) ring.count = 0;
  for (const LidarPoint& point : scan.points) {
    if (point.ring >= rings_.size()) rings_.resize(point.ring + 1U);
    ++rings_[point.ring].count;
  }
  std::size_t end = 0;
  for (Ring& ring : rings_) {
    ring.begin = end;
    ring.room = std::max(ring.room, ring.count + ring.count / 4);
    end += ring.room + kMargin;
  }
  inverse_ranges_.resize(end);
  times_.resize(end);
  indices_.resize(end);
}

/// False when there is no room.
bool MixedPixelFilter::try_sort(const LidarScan& scan) {
  for (Ring& ring : rings_) ring.count = 0;
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const LidarPoint& point = scan.points[i];
    const float squared = point.position.squaredNorm();
    if (!(squared > 0.0F) || !std::isfinite(squared)) continue;
    if (point.ring >= rings_.size()) return false;
    Ring& ring = rings_[point.ring];
    if (ring.count == ring.room) return false;
    const std::size_t at = ring.begin + ring.count++;
    inverse_ranges_[at] = squared;  // inverted by measure()
    times_[at] = point.time_offset_ns;
    indices_[at] = static_cast<std::int32_t>(i);
  }
  return true;
}

/// Inverts the ranges, and finds the interval between firings.
void MixedPixelFilter::measure(Ring& ring) {
  constexpr std::int32_t kLongest = std::numeric_limits<std::int32_t>::max();
  const std::size_t end = ring.begin + ring.count;
  for (std::size_t k = ring.begin; k < end; k += 4) {
    store4(1.0F / square_root(load4(&inverse_ranges_[k])), &inverse_ranges_[k]);
  }
  ring.interval = kLongest;
  for (std::size_t k = ring.begin + 1; k < end; ++k) {
    const std::int32_t passed = times_[k] - times_[k - 1];
    ring.interval = std::min(ring.interval, passed > 0 ? passed : kLongest);
  }
}

/// Change of the inverse range per firing, over those up to each of four from `k` on [1/m].
Float4 MixedPixelFilter::slope(std::size_t k) const {
  constexpr float kPerFiring = 1.0F / static_cast<float>(kBase);
  return kPerFiring * (load4(&inverse_ranges_[k]) - load4(&inverse_ranges_[k - kBase]));
}

/// Whether the `firings` up to each of four from `k` on came without a gap, which lengthens their
/// time by at least an interval, and without a repeated time, which shortens it.
Int4 MixedPixelFilter::whole(const Ring& ring, std::size_t k, std::int32_t firings) const {
  const Int4 span = load4(&times_[k]) - load4(&times_[k - static_cast<std::size_t>(firings)]);
  const Float4 intervals = to_float(span) / static_cast<float>(ring.interval);
  return magnitude(intervals - static_cast<float>(firings)) < Float4{} + 0.5F;
}

/// Of ranges from the line through those before them, as they are on a flat surface.
void MixedPixelFilter::add_deviations(const Ring& ring) {
  const std::size_t end = ring.begin + ring.count;
  for (std::size_t k = ring.begin + kBase + 1; k < end; k += 4 * kSampling) {
    const Float4 u = load4(&inverse_ranges_[k]);
    const Float4 past = u - load4(&inverse_ranges_[k - 1]) - slope(k - 1);
    const Float4 deviation = magnitude(past) / (u * u);
    unsigned lanes = lanes_of(whole(ring, k, kBase + 1)) & first_lanes(end - k);
    for (; lanes != 0; lanes &= lanes - 1) {
      deviations_.push_back(deviation[static_cast<std::size_t>(std::countr_zero(lanes))]);
    }
  }
}

/// The median over the returns: most lie on flat surfaces.
double MixedPixelFilter::measure_noise() {
  if (deviations_.empty()) return 0.0;
  const auto middle = deviations_.begin() + static_cast<std::ptrdiff_t>(deviations_.size() / 2);
  std::nth_element(deviations_.begin(), middle, deviations_.end());
  return *middle / (kMedianMagnitude * kPredictionNoise);
}

/// Bit i: whether there is a step between the firings `a` + i and `a` + i + 2.
unsigned MixedPixelFilter::steps_after(const Ring& ring, std::size_t a) const {
  const std::size_t b = a + 2;
  const Float4 u_a = load4(&inverse_ranges_[a]);
  const Float4 u_b = load4(&inverse_ranges_[b]);
  const Float4 past_a = u_b - (u_a + 2.0F * slope(a));
  const Float4 past_b = u_a - (u_b - 2.0F * slope(b + kBase));
  const Float4 nearer = larger(u_a, u_b);
  const auto significant = static_cast<float>(kSignificant * kPredictionNoise * range_noise_);
  const Int4 stands_out =
      smaller(magnitude(past_a), magnitude(past_b)) > significant * nearer * nearer;
  return lanes_of((past_a * past_b < 0.0F) & stands_out & whole(ring, b + kBase, kSpan));
}

void MixedPixelFilter::mark_ring(const Ring& ring) {
  const std::size_t end = ring.begin + ring.count;
  for (std::size_t a = ring.begin + kBase; a + kBase + 2 < end; a += 4) {
    unsigned lanes = steps_after(ring, a) & first_lanes(end - (a + kBase + 2));
    for (; lanes != 0; lanes &= lanes - 1) {
      const std::size_t before = a + static_cast<std::size_t>(std::countr_zero(lanes));
      const std::size_t after = before + 2;
      const std::size_t nearer = inverse_ranges_[before] > inverse_ranges_[after] ? before : after;
      marked_[static_cast<std::size_t>(indices_[before + 1])] = 1;
      marked_[static_cast<std::size_t>(indices_[nearer])] = 1;
    }
  }
}

}  // namespace aims
