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

  /// Points farther than this have no effect: five are as near, or it is the gate [m^2].
  float reach() const {
    // Five are the nearest of each lane and the nearest of the second ones.
    const Float4& a = rows_[0];
    const Float4& b = rows_[1];
    const float first = std::max(std::max(a[0], a[1]), std::max(a[2], a[3]));
    const float second = std::min(std::min(b[0], b[1]), std::min(b[2], b[3]));
    return std::max(first, second);
  }

  /// The nearest, nearest first; returns how many there are.
  std::size_t sorted(std::array<Found, kWanted>& found) const {
    std::array<std::array<std::uint32_t, 4>, kWanted + 1> keys;
    for (std::size_t k = 0; k < kWanted; ++k) {
      keys[k] = std::bit_cast<std::array<std::uint32_t, 4>>(rows_[k]);
    }
    keys[kWanted].fill(none_);
    std::array<std::size_t, 4> next{};
    for (std::size_t k = 0; k < kWanted; ++k) {
      std::uint32_t lane = 0;
      for (std::uint32_t other = 1; other < 4; ++other) {
        lane = keys[next[other]][other] < keys[next[lane]][lane] ? other : lane;
      }
      const std::uint32_t key = keys[next[lane]++][lane];
      if (key == none_) return k;
      found[k] = {key & static_cast<std::uint32_t>(kGroupBits), lane};
    }
    return kWanted;
  }

 private:
  static constexpr std::int32_t kGroupBits = 0xff;

  std::array<Float4, kWanted> rows_;  ///< of each lane, nearest first
  std::uint32_t none_ = 0;            ///< the key of the gate
};

}  // namespace aims
