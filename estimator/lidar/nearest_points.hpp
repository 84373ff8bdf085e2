// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "estimator/lidar/float4.hpp"

namespace aims {

/// The five nearest of the points offered. Each of four lanes keeps its own five, by minima and
/// maxima without branches; the nearest of all are among them. Of two points whose squared
/// distances differ by less than one part in 2^15 either may count as nearer, since the last eight
/// bits number the groups of points.
class NearestPoints {
 public:
  static constexpr std::size_t kWanted = 5;
  static constexpr std::uint32_t kMaxGroups = 255;

  /// A point found: its group of four and its place there.
  struct Found {
    std::uint32_t group = 0;
    std::uint32_t lane = 0;
  };

  /// Points up to the squared distance `gate` [m^2] count.
  explicit NearestPoints(float gate) {
    const float none = std::bit_cast<float>(std::bit_cast<std::int32_t>(gate) | kGroupBits);
    rows_.fill(Float4{none, none, none, none});
    none_ = std::bit_cast<std::uint32_t>(none);
  }

  /// Offers the four points of a group, which is below `kMaxGroups` and offered once [m^2].
  void offer(Float4 squared_distances, std::uint32_t group) {
    const Int4 bits = std::bit_cast<Int4>(squared_distances) & ~kGroupBits;
    Float4 rest = std::bit_cast<Float4>(bits | static_cast<std::int32_t>(group));
    for (Float4& row : rows_) {
      const Float4 nearer = smaller(rest, row);
      rest = larger(rest, row);
      row = nearer;
    }
  }

  /// Points farther than this have no effect on `a` and `b`: five are as near in each, or it is the
  /// gate [m^2].
  static float reach(const NearestPoints& a, const NearestPoints& b) {
    // Five are the nearest of each lane and the nearest of the second ones.
    const Float4 first =
        larger(low_lanes(a.rows_[0], b.rows_[0]), high_lanes(a.rows_[0], b.rows_[0]));
    const Float4 second =
        smaller(low_lanes(a.rows_[1], b.rows_[1]), high_lanes(a.rows_[1], b.rows_[1]));
    const Float4 both = larger(larger(first, swapped(first)), smaller(second, swapped(second)));
    return std::max(both[0], both[2]);
  }

  /// The points found, nearest first.
  struct Sorted {
    std::array<Found, kWanted> points;
    std::size_t count = 0;
  };

  /// Those of `a` and of `b`, which have the same gate: sorted side by side.
  static std::array<Sorted, 2> sorted(const NearestPoints& a, const NearestPoints& b) {
    Rows first;
    Rows second;
    for (std::size_t k = 0; k < kWanted; ++k) {
      first[k] = low_lanes(a.rows_[k], b.rows_[k]);
      second[k] = high_lanes(a.rows_[k], b.rows_[k]);
    }
    first = smallest_of(first, second);
    for (std::size_t k = 0; k < kWanted; ++k) second[k] = swapped(first[k]);
    const Rows keys = smallest_of(first, second);
    return {a.places_of(keys, 0), b.places_of(keys, 2)};
  }

 private:
  static constexpr std::int32_t kGroupBits = 0xff;
  /// In each lane five numbers, the smallest first.
  using Rows = std::array<Float4, kWanted>;

  static Float4 low_lanes(Float4 a, Float4 b) { return __builtin_shufflevector(a, b, 0, 1, 4, 5); }
  static Float4 high_lanes(Float4 a, Float4 b) { return __builtin_shufflevector(a, b, 2, 3, 6, 7); }
  static Float4 swapped(Float4 a) { return __builtin_shufflevector(a, a, 1, 0, 3, 2); }

  /// In each lane, the five smallest of both.
  static Rows smallest_of(const Rows& a, const Rows& b) {
    Rows rows;
    for (std::size_t k = 0; k < kWanted; ++k) rows[k] = smaller(a[k], b[kWanted - 1 - k]);
    // The shortest sorting network of five.
    constexpr std::array<std::array<std::size_t, 2>, 9> kPairs{
        {{0, 3}, {1, 4}, {0, 2}, {1, 3}, {0, 1}, {2, 4}, {1, 2}, {3, 4}, {2, 3}}};
    for (const auto& [i, j] : kPairs) {
      const Float4 larger_one = larger(rows[i], rows[j]);
      rows[i] = smaller(rows[i], rows[j]);
      rows[j] = larger_one;
    }
    return rows;
  }

  /// Of the points whose keys are in lane `lane` of `keys`.
  Sorted places_of(const Rows& keys, std::size_t lane) const {
    Sorted sorted;
    std::uint32_t before = none_;
    unsigned lanes = 0;
    for (const Float4& row : keys) {
      const auto key = std::bit_cast<std::uint32_t>(row[lane]);
      if (key == none_) break;
      // Points of one group that are as near as each other have one key.
      lanes = key == before ? lanes & (lanes - 1) : lanes_with(row[lane]);
      before = key;
      sorted.points[sorted.count++] = {key & static_cast<std::uint32_t>(kGroupBits),
                                       static_cast<std::uint32_t>(std::countr_zero(lanes))};
    }
    return sorted;
  }

  unsigned lanes_with(float key) const {
    Int4 here{};
    for (const Float4& row : rows_) here |= row == Float4{} + key;
    return lanes_of(here);
  }

  Rows rows_;               ///< of each lane, nearest first
  std::uint32_t none_ = 0;  ///< the key of the gate
};

}  // namespace aims
