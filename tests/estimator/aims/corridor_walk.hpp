// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <string_view>
#include <vector>

#include "core/random.hpp"
#include "estimator/aims/lidar_update.hpp"
#include "estimator/aims/presets.hpp"

namespace aims::test {

inline constexpr double kHalfLength = 15.0;  // of the corridor [m]
inline constexpr double kHalfWidth = 1.2;    // of a square cross-section [m]
inline constexpr double kRange = 6.0;        // of the LiDAR [m]
inline constexpr double kNoise = 0.01;       // of a return [m]

/// A square corridor along x, with a pillar's face across it every two metres that takes the
/// fraction `facing` of the points; its surfaces draw nearer by the angle `taper` [rad] each.
class Corridor {
 public:
  Corridor(double facing, RandomStream& random, double taper = 0.0)
      : facing_(facing), random_(random), taper_(taper) {}

  /// A noisy point of its surfaces, between the given coordinates.
  Eigen::Vector3d point(double from, double to) {
    Eigen::Vector3d p;
    p.x() = from + (to - from) * random_.uniform();
    const int wall = static_cast<int>(4.0 * random_.uniform());
    p(1 + wall % 2) = (wall < 2 ? 1.0 : -1.0) * (kHalfWidth - taper_ * p.x());
    p(2 - wall % 2) = kHalfWidth * (2.0 * random_.uniform() - 1.0);
    if (random_.uniform() < facing_) {
      p.x() = 2.0 * std::round(0.5 * p.x());
      p(1 + wall % 2) *= 0.6 + 0.4 * random_.uniform();
    }
    return p + kNoise * random_.normal3();
  }

 private:
  double facing_;
  RandomStream& random_;
  double taper_;
};

/// Puts 30000 points of the corridor between both coordinates into each half of `map`.
inline void fill(VoxelMap& map, Corridor& corridor, double from, double to) {
  for (std::size_t half = 0; half < kHalves; ++half) {
    std::vector<Eigen::Vector3f> points;
    for (int i = 0; i < 30000; ++i) points.push_back(corridor.point(from, to).cast<float>());
    map.insert(points, Eigen::Vector3f::Zero());
  }
}

/// The LiDAR update of `preset` with `part` of each scan, after 6 m along a corridor with a known
/// map.
struct CorridorWalk {
  explicit CorridorWalk(bool pillars, std::string_view preset = "aims_d", double taper = 0.0,
                        ScanPart part = ScanPart::kReal)
      : corridor(pillars ? 0.2 : 0.0, random, taper),
        map(MapConfig{}),
        update(eskf_preset(preset)) {
    fill(map, corridor, -kHalfLength, kHalfLength);
    while (truth.x() < 6.0) {
      truth.x() += 0.2;
      Belief belief;
      belief.state.position = truth;
      belief.covariance = 1e-4 * ErrorMatrix::Identity();
      (void)fuse(belief, part);
    }
  }

  /// The belief after `part` of a scan taken at `truth`, level and facing along x.
  Belief fuse(const Belief& predicted, ScanPart part = ScanPart::kReal,
              const Belief* leg_free = nullptr) {
    std::vector<Eigen::Vector3f> scan;
    for (int i = 0; i < 800; ++i) {
      const Eigen::Vector3d p = corridor.point(truth.x() - kRange, truth.x() + kRange);
      scan.push_back((p - truth).cast<float>());
    }
    diagnostics = ScanDiagnostics();
    return update.update(predicted, scan, map, CalibrationModel(), part, diagnostics, leg_free);
  }

  RandomStream random{1, "lidar_update.test"};
  Corridor corridor;
  VoxelMap map;
  LidarUpdate update;
  ScanDiagnostics diagnostics;  ///< of the last scan
  Eigen::Vector3d truth = Eigen::Vector3d::Zero();
};

}  // namespace aims::test
