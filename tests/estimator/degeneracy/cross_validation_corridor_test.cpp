// SPDX-License-Identifier: BSD-3-Clause
// The information across both halves of a noisy map against that of the same scans without noise.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "estimator/lidar/scan_matcher.hpp"
#include "estimator/lidar/scan_selection.hpp"
#include "tests/estimator/degeneracy/synthetic_corridor.hpp"

namespace aims {
namespace {

using test::CorridorCase;
using test::ScanPair;
using test::SyntheticCorridor;

constexpr int kMappedScans = 16;
constexpr int kMatchedScans = 4;
constexpr double kShift = 0.07;  // between scans [m]
constexpr int kMaxInsertions = 12000;  // as ScanPoints

/// Information about the position along the corridor, per unit of all information.
struct AlongCorridor {
  double within = 0.0;
  double across = 0.0;
  double noise_free = 0.0;
};

struct Mean {
  double value = 0.0;
  double standard_error = 0.0;
};

Mean mean_of(const std::vector<double>& values) {
  const auto count = static_cast<double>(values.size());
  double sum = 0.0;
  double squares = 0.0;
  for (double each : values) sum += each;
  for (double each : values) squares += (each - sum / count) * (each - sum / count);
  return {sum / count, std::sqrt(squares / (count - 1.0) / count)};
}

/// A robot that maps a corridor at known poses and matches scans with the map, with the selection,
/// the map and the matcher of the estimator at their defaults; beside it the same without noise.
class MappedCorridor {
 public:
  MappedCorridor(const CorridorCase& setup, std::uint64_t seed) : corridor_(setup, seed) {
    sensor_.x() = corridor_.random().uniform(0.0, 4.0);
    sensor_.y() = setup.width * corridor_.random().uniform(-0.15, 0.15);
    sensor_.z() = corridor_.random().uniform(0.5, 0.7);
    matcher_.reset(Eigen::Vector3d::Zero());
    for (int i = 0; i < kMappedScans; ++i) map(next());
  }

  /// Of the scans after those that started the map.
  AlongCorridor measure() {
    HalvesInformation noisy;
    HalvesInformation exact;
    for (int i = 0; i < kMatchedScans; ++i) {
      const ScanPair scan = next();
      match(scan, noisy, exact);
      map(scan);
    }
    constexpr int x = ErrorState::kPosition.offset;
    const double all = noisy.within.bottomRightCorner<3, 3>().trace();
    const double all_exact = exact.within.bottomRightCorner<3, 3>().trace();
    return {noisy.within(x, x) / all, noisy.across(x, x) / all, exact.across(x, x) / all_exact};
  }

 private:
  static void add(const HalvesInformation& scan, HalvesInformation& sum) {
    sum.within += scan.within;
    sum.across += scan.across;
  }

  ScanPair next() {
    sensor_.x() += kShift;
    sensor_.z() += 0.01 * corridor_.random().normal();
    return corridor_.scan(sensor_);
  }

  std::vector<Eigen::Vector3f> select(const LidarScan& scan, double voxel, int limit) {
    selection_.begin(scan);
    selection_.select(voxel, limit, kept_);
    std::vector<Eigen::Vector3f> points;
    for (int i : kept_) points.push_back(scan.points[static_cast<std::size_t>(i)].position);
    return points;
  }

  void map(const ScanPair& pair) {
    const Eigen::Vector3f at = sensor_.cast<float>();
    for (const auto& [scan, into] : {std::pair(&pair.noisy, &map_), {&pair.exact, &exact_map_}}) {
      auto points = select(*scan, map_config_.insertion_voxel, kMaxInsertions);
      for (Eigen::Vector3f& point : points) point += at;
      into->insert(points, at);
    }
  }

  MatchInformation match(std::span<const Eigen::Vector3f> points, const VoxelMap& map) {
    const Pose pose{Eigen::Quaterniond::Identity(), sensor_};
    matcher_.match(pose, points, map);
    return matcher_.linearize(pose);
  }

  /// Adds the returns that are accepted with noise and without, one by one.
  void match(const ScanPair& scan, HalvesInformation& noisy, HalvesInformation& exact) {
    const auto points = select(scan.noisy, lidar_.selection_voxel, lidar_.max_points);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto& point = scan.exact.points[static_cast<std::size_t>(kept_[i])].position;
      const MatchInformation with = match(std::span(&points[i], 1), map_);
      const MatchInformation without = match(std::span(&point, 1), exact_map_);
      if (with.used == 0 || without.used == 0) continue;
      add(with.halves, noisy);
      add(without.halves, exact);
    }
    (void)match(points, map_);
    matcher_.learn_noise();
  }

  SyntheticCorridor corridor_;
  LidarUpdateConfig lidar_;
  MapConfig map_config_;
  ScanSelection selection_{lidar_};
  ScanMatcher matcher_{LidarUpdateConfig{}.correlated_points, RobustKernelConfig{}};
  VoxelMap map_{map_config_};
  VoxelMap exact_map_{map_config_};
  Eigen::Vector3d sensor_ = Eigen::Vector3d::Zero();
  std::vector<int> kept_;
};

struct Means {
  Mean within;
  Mean across;
  Mean noise_free;
  Mean excess;  ///< of across over noise-free
};

Means measure(const CorridorCase& setup, int repetitions) {
  std::vector<double> within;
  std::vector<double> across;
  std::vector<double> noise_free;
  std::vector<double> excess;
  for (int i = 0; i < repetitions; ++i) {
    const AlongCorridor one = MappedCorridor(setup, static_cast<std::uint64_t>(i)).measure();
    within.push_back(one.within);
    across.push_back(one.across);
    noise_free.push_back(one.noise_free);
    excess.push_back(one.across - one.noise_free);
  }
  return {mean_of(within), mean_of(across), mean_of(noise_free), mean_of(excess)};
}

CorridorCase smooth(double noise, int rings, double range, double width) {
  CorridorCase setup;
  setup.noise = noise;
  setup.rings = rings;
  setup.range = range;
  setup.width = width;
  return setup;
}

CorridorCase with_pillars(CorridorCase setup, double spacing, double depth) {
  setup.spacing = spacing;
  setup.depth = depth;
  return setup;
}

const std::vector<CorridorCase> kSmooth = {
    smooth(0.005, 16, 30.0, 2.2), smooth(0.02, 32, 30.0, 2.2), smooth(0.02, 64, 60.0, 1.5),
    smooth(0.02, 8, 10.0, 3.0),   smooth(0.03, 16, 60.0, 6.0), smooth(0.05, 32, 20.0, 3.0)};

std::string name_of(const CorridorCase& setup) {
  return std::to_string(setup.rings) + " rings, noise " + std::to_string(setup.noise) + ", depth " +
         std::to_string(setup.depth);
}

// What is left without noise are planes around the edges of walls and floor, whose tilt depends on
// where the rings lie.
TEST(CrossValidation, AlongSmoothWallsNoiseAddsNothingAcross) {
  for (const CorridorCase& setup : kSmooth) {
    const Mean excess = measure(setup, 10).excess;
    // Noise of 5 cm acts along the beam and may tilt the fits of both halves alike: by less than
    // what counts as free.
    const double alike = setup.noise < 0.04 ? 0.0 : kFreeTilt * kFreeTilt;
    EXPECT_LT(std::abs(excess.value), alike + 3.0 * excess.standard_error) << name_of(setup);
  }
}

TEST(CrossValidation, AcrossIsTheInformationWithoutNoise) {
  for (const CorridorCase& setup : kSmooth) {
    const bool recess = setup.rings == 32;
    const CorridorCase features = with_pillars(setup, 4.0, recess ? -0.5 : 0.5);
    const Means means = measure(features, 8);
    EXPECT_NEAR(means.across.value / means.noise_free.value, 1.0, 0.15) << name_of(features);
    EXPECT_GT(means.within.value, means.across.value) << name_of(features);
  }
}

}  // namespace
}  // namespace aims
