// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/measurements.hpp"
#include "recordings/inspection/bag_info.hpp"

namespace aims {

/// Finds the longest interval without motion in a stream of inertial samples, in windows of a
/// second.
class StaticIntervalFinder {
 public:
  /// `sample` in rad/s and m/s^2.
  void add(const ImuSample& sample);

  /// The longest interval of at least a second.
  std::optional<StaticInterval> longest() const;

 private:
  /// Sums over samples relative to the first one, against cancellation.
  struct Sums {
    Time begin = 0;
    Time end = 0;
    int samples = 0;
    Eigen::Vector3d rate = Eigen::Vector3d::Zero();
    Eigen::Vector3d rate_squares = Eigen::Vector3d::Zero();
    Eigen::Vector3d force = Eigen::Vector3d::Zero();
    Eigen::Vector3d force_squares = Eigen::Vector3d::Zero();
    double time = 0.0, time_squares = 0.0;  ///< of a window, since its begin
    Eigen::Vector3d force_by_time = Eigen::Vector3d::Zero();

    void add(const ImuSample& sample, const ImuSample& origin);
    void add(const Sums& other);
  };

  void close_window();
  bool is_static(const Sums& window) const;
  bool turns(const Sums& window) const;

  std::optional<ImuSample> origin_;
  std::optional<Time> first_;  ///< earliest stamp
  Sums window_;                ///< of the current second
  Sums interval_;              ///< of the static windows up to now
  Sums longest_;
};

}  // namespace aims
