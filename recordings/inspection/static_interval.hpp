// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/measurements.hpp"
#include "recordings/inspection/bag_info.hpp"

namespace aims {

/// Finds the longest standstill in a stream of inertial samples, second by second.
class StaticIntervalFinder {
 public:
  /// `sample` in rad/s and m/s^2.
  void add(const ImuSample& sample);

  /// The longest stretch of at least a second.
  std::optional<StaticInterval> longest() const;

 private:
  /// Sums over samples, about the first one's values so that nothing cancels.
  struct Sums {
    Time begin = 0;
    Time end = 0;
    int samples = 0;
    Eigen::Vector3d rate = Eigen::Vector3d::Zero();
    Eigen::Vector3d rate_squares = Eigen::Vector3d::Zero();
    Eigen::Vector3d force = Eigen::Vector3d::Zero();
    Eigen::Vector3d force_squares = Eigen::Vector3d::Zero();

    void add(const ImuSample& sample, const ImuSample& origin);
    void add(const Sums& other);
  };

  void close_window();
  bool is_still(const Sums& window) const;

  std::optional<ImuSample> origin_;
  Sums window_;   ///< of the present second
  Sums stretch_;  ///< of the windows at rest up to now
  Sums longest_;
};

}  // namespace aims
