// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "estimator/filter/kalman_update.hpp"
#include "estimator/lidar/scan_matcher.hpp"

namespace aims {

/// What a rule found out about a scan.
struct ScanVerdict {
  bool rotation = false;     ///< the scan leaves a rotation unconstrained
  bool translation = false;  ///< the scan leaves a translation unconstrained
  bool partial = false;      ///< some of its correspondences alone decide along a direction
};

/// A belief after a scan.
struct RuledUpdate {
  Belief belief;
  ScanVerdict verdict;
};

/// Another update of the filter with a scan than the plain one, for scans that leave directions of
/// the pose unconstrained.
class ScanRule {
 public:
  virtual ~ScanRule() = default;

  /// One step of the iterated update: `prior` after fusing `scan`, which is linearized at
  /// `linearization`, where its matches are `correspondences`. Of the states the scan corrects
  /// those of its mask, as in the plain update.
  virtual RuledUpdate fuse(const Belief& prior, const NominalState& linearization,
                           const Linearization& scan,
                           std::span<const Correspondence> correspondences) const = 0;
};

}  // namespace aims
