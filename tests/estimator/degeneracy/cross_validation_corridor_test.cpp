// SPDX-License-Identifier: BSD-3-Clause
// The information across both halves of a noisy map against that of the true surfaces.
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
using test::LabelledScan;
using test::SyntheticCorridor;

constexpr int kMappedScans = 16;
constexpr int kMatchedScans = 4;
constexpr double kShift = 0.07;  // between scans [m]

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
/// the map and the matcher of the estimator at their defaults.
class MappedCorridor {
 public:
  MappedCorridor(const CorridorCase& setup, std::uint64_t seed)
      : setup_(setup), corridor_(setup, seed) {
    sensor_.y() = setup.width * corridor_.random().uniform(-0.15, 0.15);
    sensor_.z() = 0.5 + 0.2 * corridor_.random().uniform();
    sensor_.x() = corridor_.random().uniform(0.0, 4.0);
    matcher_.reset(Eigen::Vector3d::Zero());
    for (int i = 0; i < kMappedScans; ++i) map(next());
  }

  /// Of the scans after those that started the map.
  AlongCorridor measure() {
    AlongCorridor sum;
    double all = 0.0;
    for (int i = 0; i < kMatchedScans; ++i) {
      const LabelledScan scan = next();
      all += match(scan, sum);
      map(scan);
    }
    return {sum.within / all, sum.across / all, sum.noise_free / all};
  }

 private:
  LabelledScan next() {
    sensor_.x() += kShift;
    sensor_.z() += 0.01 * corridor_.random().normal();
    return corridor_.scan(sensor_);
  }

  void map(const LabelledScan& scan) {
    selection_.select(scan.scan, map_config_.insertion_voxel, map_config_.max_insertions, kept_);
    std::vector<Eigen::Vector3f> points;
    for (int i : kept_) points.push_back(scan.scan.points[i].position + sensor_.cast<float>());
    map_.insert(points, sensor_.cast<float>());
  }

  /// Adds the returns of a scan to `sum`, one by one; returns the information of all directions.
  double match(const LabelledScan& scan, AlongCorridor& sum) {
    constexpr int x = ErrorState::kPosition.offset;
    NominalState state;
    state.position = sensor_;
    selection_.select(scan.scan, lidar_.selection_voxel, lidar_.max_points, kept_);
    std::vector<Eigen::Vector3f> points;
    double all = 0.0;
    for (int i : kept_) {
      points.push_back(scan.scan.points[i].position);
      matcher_.match(state, std::span(&points.back(), 1), map_);
      const HalvesInformation halves = matcher_.linearize(state).halves;
      const double weight = halves.within.bottomRightCorner<3, 3>().trace();
      all += weight;
      sum.within += halves.within(x, x);
      sum.across += halves.across(x, x);
      sum.noise_free += scan.axes[i] == 0 ? weight : 0.0;
    }
    matcher_.match(state, points, map_);
    (void)matcher_.linearize(state);
    matcher_.learn_noise();
    return all;
  }

  CorridorCase setup_;
  SyntheticCorridor corridor_;
  LidarUpdateConfig lidar_;
  MapConfig map_config_;
  ScanSelection selection_{lidar_};
  ScanMatcher matcher_{lidar_, RobustKernelConfig{}, map_config_.plane_thickness};
  VoxelMap map_{map_config_};
  Eigen::Vector3d sensor_ = Eigen::Vector3d::Zero();
  std::vector<int> kept_;
};

struct Means {
  Mean within;
  Mean across;
  Mean noise_free;
};

Means measure(const CorridorCase& setup, int repetitions) {
  std::vector<double> within;
  std::vector<double> across;
  std::vector<double> noise_free;
  for (int i = 0; i < repetitions; ++i) {
    const AlongCorridor one = MappedCorridor(setup, static_cast<std::uint64_t>(i)).measure();
    within.push_back(one.within);
    across.push_back(one.across);
    noise_free.push_back(one.noise_free);
  }
  const Means means{mean_of(within), mean_of(across), mean_of(noise_free)};
  if (std::getenv("SHOW")) printf("w %.1f spacing %.1f depth %.2f rings %d range %.0f noise %.3f: within %.5f across %.5f +- %.5f free %.5f\n", setup.width, setup.spacing, setup.depth, setup.rings, setup.range, setup.noise, means.within.value, means.across.value, means.across.standard_error, means.noise_free.value);
  return means;
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

const std::vector<CorridorCase> kSmooth = {smooth(0.005, 16, 30.0, 2.2), smooth(0.02, 32, 30.0, 2.2),
                                           smooth(0.02, 64, 60.0, 1.5), smooth(0.02, 8, 10.0, 3.0),
                                           smooth(0.03, 16, 60.0, 6.0), smooth(0.05, 32, 20.0, 3.0)};

TEST(CrossValidation, SmoothWallsHaveNoInformationAcross) {
  for (const CorridorCase& setup : kSmooth) {
    const Means means = measure(setup, 10);
    EXPECT_LT(std::abs(means.across.value), 3.0 * means.across.standard_error)
        << setup.rings << " rings, noise " << setup.noise;
    EXPECT_GT(means.within.value, 3.0 * std::abs(means.across.value))
        << setup.rings << " rings, noise " << setup.noise;
  }
}

TEST(CrossValidation, AcrossIsTheInformationOfTheTrueSurfaces) {
  for (const CorridorCase& setup : kSmooth) {
    for (const auto& [spacing, depth] : {std::pair{4.0, 0.4}, {3.0, -0.3}}) {
      const Means means = measure(with_pillars(setup, spacing, depth), 10);
      EXPECT_NEAR(means.across.value / means.noise_free.value, 1.0, 0.15)
          << setup.rings << " rings, noise " << setup.noise << ", depth " << depth;
      EXPECT_GT(means.within.value, means.across.value);
    }
  }
}

}  // namespace
}  // namespace aims
