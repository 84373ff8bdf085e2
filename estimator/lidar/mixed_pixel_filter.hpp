// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/measurements.hpp"
#include "estimator/lidar/float4.hpp"

namespace aims {

/// Finds the returns where a surface ends in front of another one, which would move a scan too far
/// along a corridor with recesses (docs/estimators.md):
/// - mixed returns: the footprint of a beam covers both surfaces and its echo lies between them, by
///   1 to 4 %. Such returns lie where nothing is, farther along the beam the flatter the surfaces
///   are seen, so they follow the robot;
/// - the last returns of the nearer surface: what comes after them is hidden from the scan, but not
///   from the map, whose planes tilt towards it. Returns on both sides of such an edge balance each
///   other, and here those of one side are missing; by about 0.05 %.
///
/// Along a ring the inverse range of a flat surface is linear in the angle. Between two returns
/// there is a step when the nearer one lies in front of the line through the returns beyond the
/// farther one, and the farther one behind the line through those beyond the nearer one. At a
/// corner, where the surfaces meet, both lie on the same side. A return with a step between its
/// neighbours may be mixed; the nearer one of these is the last of its surface.
class MixedPixelFilter {
 public:
  /// Marks such returns of `scan`. What counts as a step follows from the range noise of the scan
  /// itself. Returns without rings deviate from lines everywhere; then no step stands out.
  void mark(const LidarScan& scan);

  /// Whether return `i` of the scan is marked.
  bool marked(std::size_t i) const { return marked_[i] != 0; }

  /// Deviation of a range, from the differences between the returns of a ring [m].
  double range_noise() const { return range_noise_; }

 private:
  /// The firings of a ring in order, from `begin` on in the lists below.
  struct Ring {
    std::size_t begin = 0;
    std::size_t count = 0;
    std::size_t room = 0;       ///< firings that the lists have room for
    std::int32_t interval = 0;  ///< shortest between two firings [ns]
  };

  void sort(const LidarScan& scan);
  void make_room(const LidarScan& scan);
  bool try_sort(const LidarScan& scan);
  void measure(Ring& ring);
  Float4 slope(std::size_t k) const;
  Int4 whole(const Ring& ring, std::size_t k, std::int32_t firings) const;
  void add_deviations(const Ring& ring);
  double measure_noise();
  unsigned steps_after(const Ring& ring, std::size_t a) const;
  void mark_ring(const Ring& ring);

  std::vector<char> marked_;
  std::vector<Ring> rings_;
  std::vector<float> inverse_ranges_;  ///< [1/m]
  std::vector<std::int32_t> times_;    ///< after the scan's stamp [ns]
  std::vector<std::int32_t> indices_;  ///< into the scan
  std::vector<float> deviations_;      ///< of ranges from the line before them [m]
  double range_noise_ = 0.0;
};

}  // namespace aims
