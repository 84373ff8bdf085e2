// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "core/lie.hpp"
#include "core/random.hpp"
#include "estimator/filter/kalman_update.hpp"

namespace aims::test {

/// A corridor along x, 2.2 m wide, without ceiling, over ground of any height.
struct GroundScene {
  std::function<double(double, double)> height = [](double, double) { return 0.0; };
  double noise = 0.02;  ///< of a range [m]
};

/// Of the body above the ground [m].
inline constexpr double kHeight = 0.32;

/// A belief at the pose with the deviations of a standing start.
inline Belief belief_at(const Pose& pose, double sigma_tilt = 5e-3, double sigma_z = 1e-4) {
  Belief belief;
  belief.state.rotation = pose.rotation;
  belief.state.position = pose.translation;
  belief.covariance = ErrorMatrix::Identity() * 1e-4;
  block(belief.covariance, ErrorState::kRotation, ErrorState::kRotation) =
      Eigen::Matrix3d::Identity() * sigma_tilt * sigma_tilt;
  block(belief.covariance, ErrorState::kPosition, ErrorState::kPosition) =
      Eigen::Matrix3d::Identity() * sigma_z * sigma_z;
  block(belief.covariance, ErrorState::kAccelerometerBias, ErrorState::kAccelerometerBias) =
      Eigen::Matrix3d::Identity() * 0.05 * 0.05;
  return belief;
}

/// Height [m] of ground that rises by `grade` from `start` over `length`.
inline double ramp_height(double x, double start, double length, double grade) {
  return grade * std::clamp(x - start, 0.0, length);
}

/// Returns of 16 rings from -15 to 15 degrees, in body axes, seen at T_world_body; the LiDAR sits
/// 0.16 m above the body. Rays are followed in steps of 1 cm up to 8 m.
inline std::vector<Eigen::Vector3f> scan_ground(const GroundScene& scene, const Pose& T_world_body,
                                                RandomStream& random) {
  constexpr int kColumns = 300;
  constexpr double kStep = 0.01;
  const Eigen::Vector3d lidar(-0.1, 0.0, 0.16);
  const Eigen::Vector3d origin = T_world_body * lidar;
  std::vector<Eigen::Vector3f> points;
  for (int ring = 0; ring < 16; ++ring) {
    const double elevation = (-15.0 + 2.0 * ring) * std::numbers::pi / 180.0;
    for (int column = 0; column < kColumns; ++column) {
      const double azimuth = 2.0 * std::numbers::pi * column / kColumns;
      const Eigen::Vector3d ray(std::cos(elevation) * std::cos(azimuth),
                                std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
      const Eigen::Vector3d direction = T_world_body.rotation * ray;
      for (double range = 0.4; range < 8.0; range += kStep) {
        const Eigen::Vector3d p = origin + range * direction;
        if (std::abs(p.y()) < 1.1 && p.z() > scene.height(p.x(), p.y())) continue;
        // Half a step back: the surface on average.
        const double measured = range - 0.5 * kStep + scene.noise * random.normal();
        points.push_back((lidar + measured * ray).cast<float>());
        break;
      }
    }
  }
  return points;
}

}  // namespace aims::test
