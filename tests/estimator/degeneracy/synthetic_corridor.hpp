// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/measurements.hpp"
#include "core/random.hpp"

namespace aims::test {

/// A corridor along x whose walls may have pillars (or recesses) at regular distances, and the
/// LiDAR that scans it.
struct CorridorCase {
  double width = 2.2;    ///< [m]
  double height = 2.6;   ///< [m]
  double spacing = 0.0;  ///< between pillars; 0: smooth walls [m]
  double depth = 0.0;    ///< of a pillar out of the wall; negative: a recess into it [m]
  double breadth = 0.8;  ///< of a pillar, along the wall [m]
  int rings = 32;
  double elevation = 0.39;  ///< of the outermost rings, up and down [rad]
  double range = 30.0;      ///< [m]
  double noise = 0.02;      ///< along the beam [m]
};

/// A surface of the corridor: the rectangle between `low` and `high` across `axis`.
struct Face {
  int axis = 0;
  Eigen::Vector3d low;
  Eigen::Vector3d high;
};

/// The same scan with and without noise, in sensor axes, which are those of the corridor.
struct ScanPair {
  LidarScan noisy;
  LidarScan exact;
};

/// Simulates scans by closed-form intersection.
class SyntheticCorridor {
 public:
  SyntheticCorridor(const CorridorCase& setup, std::uint64_t seed);

  /// A scan from `sensor`, whose scan pattern starts at a random azimuth.
  ScanPair scan(const Eigen::Vector3d& sensor);

  RandomStream& random() { return random_; }

 private:
  void add_wall(double y, double outward);
  double half_length() const { return setup_.range + 10.0; }

  CorridorCase setup_;
  RandomStream random_;
  std::vector<Face> faces_;
};

}  // namespace aims::test
