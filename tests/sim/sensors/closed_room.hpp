// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <limits>

#include "tests/sim/sensors/lidar_scans.hpp"

namespace aims::testing {

/// A closed room of six planes with a LiDAR that stands still, and what each beam must measure,
/// from the planes alone.
struct ClosedRoom {
  double reflectivity = 0.5;
  Eigen::Vector3d low{-6.0, -4.0, 0.0};
  Eigen::Vector3d high{7.0, 3.0, 3.2};
  Eigen::Vector3d sensor{0.4, -0.3, 1.3};

  Scene scene() const {
    constexpr double kThick = 0.1;
    Scene scene;
    const Eigen::Vector3d middle = 0.5 * (low + high);
    for (int axis = 0; axis < 3; ++axis) {
      for (const double side : {low[axis] - kThick, high[axis] + kThick}) {
        Solid wall;
        wall.T_world_solid.translation = middle;
        wall.T_world_solid.translation[axis] = side;
        wall.half_extents = 0.5 * (high - low) + Eigen::Vector3d::Constant(1.0);
        wall.half_extents[axis] = kThick;
        wall.material.reflectivity = reflectivity;
        if (axis < 2 || side > 0.0) scene.solids.push_back(wall);
      }
    }
    scene.floor.material.reflectivity = reflectivity;
    return scene;
  }

  struct Return {
    double range = std::numeric_limits<double>::infinity();  ///< [m]
    double cosine = 0.0;
  };

  Return along(const Eigen::Vector3d& direction) const {
    Return nearest;
    for (int axis = 0; axis < 3; ++axis) {
      if (direction[axis] == 0.0) continue;
      const double plane = direction[axis] > 0.0 ? high[axis] : low[axis];
      const double range = (plane - sensor[axis]) / direction[axis];
      if (range < nearest.range) nearest = {range, std::abs(direction[axis])};
    }
    return nearest;
  }

  Trajectory poses() const { return {{0, {Eigen::Quaterniond::Identity(), sensor}}}; }
};

/// Mean and deviation of numbers.
struct Spread {
  double sum = 0.0, squares = 0.0;
  int count = 0;

  void add(double value) {
    sum += value;
    squares += value * value;
    ++count;
  }
  double mean() const { return sum / count; }
  double std() const { return std::sqrt(squares / count - mean() * mean()); }
};

}  // namespace aims::testing
