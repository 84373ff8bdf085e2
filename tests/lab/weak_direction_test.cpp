// SPDX-License-Identifier: BSD-3-Clause
#include "lab/weak/weak_direction.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sim/environment/scene_config.hpp"
#include "sim/sensors/fisher_information.hpp"

namespace aims {
namespace {

using Eigen::Vector3d;

constexpr double kTexture = 0.2;
constexpr double kWave = 1.024;  // [m]; whole waves fit the periods of the field
constexpr double kNoise = 0.05;

/// A wall whose face lies at y = 2, with a texture of one wavelength.
Scene textured_wall() {
  Scene scene;
  Solid wall;
  wall.half_extents = Vector3d(40.0, 0.1, 4.0);
  wall.T_world_solid.translation = Vector3d(0.0, 2.1, 4.0);
  scene.solids.push_back(wall);
  scene.surface.texture = kTexture;
  scene.surface.shortest = scene.surface.longest = kWave;
  scene.surface_seed = 3;
  return scene;
}

struct Returns {
  LidarScan scan;
  ScanTruth hits;
};

/// Returns of beams from a sensor far away, nearly along the normal.
Returns returns_of(const Vector3d& p_world_lidar) {
  Returns returns;
  for (double x = -30.0; x < 30.0; x += 0.11) {
    for (double z = 0.3; z < 7.7; z += 0.13) {
      const Vector3d point(x, 2.0, z);
      LidarPoint& measured = returns.scan.points.emplace_back();
      measured.intensity = 0.5F;
      returns.hits.points.push_back(point.cast<float>());
      returns.hits.normals.push_back(-Eigen::Vector3f::UnitY());
      returns.hits.surfaces.push_back(0);
      returns.hits.cosines.push_back(static_cast<float>((point - p_world_lidar).normalized().y()));
    }
  }
  return returns;
}

LidarConfig sensor() {
  LidarConfig config;
  config.intensity_sigma = kNoise;
  return config;
}

// An isotropic field of one wavelength L and deviation t has gradients of mean square
// (2 pi t / L)^2 / 2 along any direction.
TEST(WeakDirection, IntensityOfATextureOfOneWavelengthHasItsInformation) {
  const RayCaster caster(textured_wall());
  const Vector3d far(0.0, -1000.0, 4.0);
  const Returns returns = returns_of(far);
  const ScanTruth rows = intensity_rows(caster, sensor(), returns.scan, returns.hits, far);
  const ScanInformation result = scan_information(0, rows, {}, 1.0);
  const double slope = 2.0 * std::numbers::pi * kTexture / kWave;
  const double expected =
      static_cast<double>(returns.hits.points.size()) * 0.5 * std::pow(slope / kNoise, 2);
  // One realization of 160 waves, through a grid of 4 cm and differences over 4 cm.
  EXPECT_NEAR(result.information(3, 3), expected, 0.25 * expected);
  EXPECT_NEAR(result.information(5, 5), expected, 0.25 * expected);
  // A step along the normal does not move the hits of beams along it.
  EXPECT_NEAR(result.information(4, 4), 0.0, 1e-3 * expected);
}

TEST(WeakDirection, IntensityOfOneReflectivityTellsNothing) {
  Scene scene = textured_wall();
  scene.surface.texture = 0.0;
  scene.surface.relief = 0.001;
  const RayCaster caster(scene);
  const Vector3d far(0.0, -1000.0, 4.0);
  const Returns returns = returns_of(far);
  const ScanTruth rows = intensity_rows(caster, sensor(), returns.scan, returns.hits, far);
  EXPECT_LT(scan_information(0, rows, {}, 1.0).information(3, 3), 1e-3);
}

// With a step of q the intensity I has a relative noise of q / (sqrt(12) I) on top.
TEST(WeakDirection, CoarseIntensityTellsLess) {
  const RayCaster caster(textured_wall());
  const Vector3d far(0.0, -1000.0, 4.0);
  const Returns returns = returns_of(far);
  LidarConfig coarse = sensor();
  coarse.intensity_resolution = 0.1;
  const auto information = [&](const LidarConfig& config) {
    const ScanTruth rows = intensity_rows(caster, config, returns.scan, returns.hits, far);
    return scan_information(0, rows, {}, 1.0).information(3, 3);
  };
  const double rounding = 0.1 / (std::sqrt(12.0) * 0.5);
  EXPECT_NEAR(information(coarse) / information(sensor()),
              kNoise * kNoise / (kNoise * kNoise + rounding * rounding), 1e-3);
}

}  // namespace
}  // namespace aims
