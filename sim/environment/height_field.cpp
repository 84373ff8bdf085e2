// SPDX-License-Identifier: BSD-3-Clause
#include "sim/environment/height_field.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/random.hpp"

namespace aims {
namespace {

constexpr int kWaves = 64;
constexpr double kCellsPerLength = 4.0;  ///< grid cells per correlation length

struct Wave {
  Eigen::Vector2d number;  ///< [rad/m]
  double phase;            ///< [rad]
};

/// Plane waves whose sum is close to a Gaussian field with that correlation length.
std::array<Wave, kWaves> random_waves(double correlation_length, std::uint64_t seed) {
  RandomStream random = rng(seed, "scene.bumps");
  std::array<Wave, kWaves> waves;
  for (Wave& wave : waves) {
    const Eigen::Vector3d normal = random.normal3();
    wave.number = normal.head<2>() / correlation_length;
    wave.phase = random.uniform(0.0, 2.0 * std::numbers::pi);
  }
  return waves;
}

/// The field's value mapped to (0, 1), evenly distributed.
double unit_height(const std::array<Wave, kWaves>& waves, const Eigen::Vector2d& point) {
  double sum = 0.0;
  for (const Wave& wave : waves) sum += std::cos(wave.number.dot(point) + wave.phase);
  const double sigma = std::sqrt(0.5 * kWaves);
  return 0.5 * std::erfc(-sum / (sigma * std::numbers::sqrt2));
}

constexpr double kMaxGridPoints = 2e6;

int grid_points(double length, double cell) {
  return std::max(2, static_cast<int>(std::ceil(length / cell)) + 1);
}

double cell_of(const BumpConfig& bumps) { return bumps.correlation_length / kCellsPerLength; }

}  // namespace

Result<void> validate(const BumpConfig& bumps, const Floor& floor) {
  if (bumps.height <= 0.0) return {};
  const Eigen::Vector2d size = floor.max_corner - floor.min_corner;
  const double points = size.prod() / (cell_of(bumps) * cell_of(bumps));
  if (points <= kMaxGridPoints) return {};
  return failure(
      fmt::format("scene.bumps.correlation_length: expected at least {:.2g} m for a floor of "
                  "{:.0f} m x {:.0f} m "
                  "({:.0g} grid points), got {}",
                  kCellsPerLength * std::sqrt(size.prod() / kMaxGridPoints), size.x(), size.y(),
                  kMaxGridPoints, bumps.correlation_length));
}

void add_bumps(const BumpConfig& bumps, std::uint64_t seed, Floor& floor) {
  if (bumps.height <= 0.0) return;
  const Eigen::Vector2d size = floor.max_corner - floor.min_corner;
  const double cell = cell_of(bumps);
  floor.columns = grid_points(size.x(), cell);
  floor.rows = grid_points(size.y(), cell);
  const auto waves = random_waves(bumps.correlation_length, seed);
  const Eigen::Vector2d step(size.x() / (floor.columns - 1), size.y() / (floor.rows - 1));
  floor.heights.clear();
  for (int row = 0; row < floor.rows; ++row) {
    for (int column = 0; column < floor.columns; ++column) {
      const Eigen::Vector2d point =
          floor.min_corner + step.cwiseProduct(Eigen::Vector2d(column, row));
      floor.heights.push_back(static_cast<float>(bumps.height * unit_height(waves, point)));
    }
  }
}

}  // namespace aims
