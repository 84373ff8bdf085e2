// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/measurements.hpp"

namespace aims {

/// Finds mixed returns: where a surface ends in front of another one, the footprint of a beam
/// covers both and its echo lies between them. Such returns lie where nothing is, farther along the
/// beam the flatter the surfaces are seen, so they follow the robot; and a scan that is matched
/// with a map of them moves too far, by 1 to 4 % along a corridor with recesses
/// (docs/estimators.md).
///
/// Along a ring the inverse range of a flat surface is linear in the angle. Between two returns
/// there is a step when the nearer one lies in front of the line through the returns beyond the
/// farther one, and the farther one behind the line through those beyond the nearer one. At a
/// corner, where the surfaces meet, both lie on the same side. A return with a step between its
/// neighbours is mixed.
class RangeSteps {
 public:
  /// Marks the mixed returns of `scan`. What counts as a step follows from the range noise of the
  /// scan itself. Returns without rings deviate from lines everywhere; then no step stands out.
  void mark(const LidarScan& scan);

  /// Whether return `i` of the scan that was marked is mixed.
  bool mixed(std::size_t i) const { return mixed_[i] != 0; }

  /// Deviation of a range, from the differences between the returns of a ring [m].
  double range_noise() const { return range_noise_; }

 private:
  /// A return in the order of its ring.
  struct Firing {
    std::int32_t index = 0;           ///< in the scan
    std::int32_t time_offset_ns = 0;  ///< after the scan's stamp
    std::int32_t run = 0;             ///< firings before it without a gap
    double inverse_range = 0.0;       ///< [1/m]
    double slope = 0.0;  ///< change of the inverse range per firing, over those before it [1/m]
  };
  using Ring = std::span<Firing>;

  void list_firings(const LidarScan& scan);
  static void count_runs(const Ring& ring);
  double measure_noise();
  bool steps_after(const Ring& ring, std::size_t a) const;
  void mark_ring(const Ring& ring);

  std::vector<char> mixed_;
  std::vector<Firing> firings_;  ///< ring by ring
  std::vector<Ring> rings_;
  std::vector<std::size_t> ring_begins_;  ///< of each ring in the firings
  std::vector<std::size_t> ring_ends_;
  std::vector<double> deviations_;
  double range_noise_ = 0.0;
};

}  // namespace aims
