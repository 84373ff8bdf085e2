// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/aims/lidar_update.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/random.hpp"

namespace aims {
namespace {

using E = ErrorState;

constexpr double kHalfLength = 15.0;  // of the corridor [m]
constexpr double kHalfWidth = 1.2;    // of a square cross-section [m]
constexpr double kRange = 6.0;        // of the LiDAR [m]
constexpr double kNoise = 0.01;       // of a return [m]

/// A square corridor along x, plain or with a pillar's face across it every two metres.
class Corridor {
 public:
  Corridor(bool pillars, RandomStream& random) : pillars_(pillars), random_(random) {}

  /// A noisy point of its surfaces, between the given coordinates.
  Eigen::Vector3d point(double from, double to) {
    Eigen::Vector3d p;
    p.x() = from + (to - from) * random_.uniform();
    const int wall = static_cast<int>(4.0 * random_.uniform());
    p(1 + wall % 2) = wall < 2 ? kHalfWidth : -kHalfWidth;
    p(2 - wall % 2) = kHalfWidth * (2.0 * random_.uniform() - 1.0);
    if (pillars_ && random_.uniform() < 0.2) {
      p.x() = 2.0 * std::round(0.5 * p.x());
      p(1 + wall % 2) *= 0.6 + 0.4 * random_.uniform();
    }
    return p + kNoise * random_.normal3();
  }

 private:
  bool pillars_;
  RandomStream& random_;
};

EstimatorConfig config_with(bool gate_learning) {
  EstimatorConfig config;
  config.directional.leg_states.gate_learning = gate_learning;
  // These walls have no edges: the residuals of the plane fits do not overstate the noise.
  config.directional.noise_information.scale = 1.0;
  return config;
}

LidarUpdate make_update(const EstimatorConfig& config, const EstimatorVariant& variant) {
  return {config_for(variant, config), variant};
}

/// The LiDAR update, directional unless that is switched off, after 6 m along a corridor with a
/// known map.
struct Sequence {
  explicit Sequence(bool pillars, bool gate_learning = true, bool directional = true)
      : corridor(pillars, random),
        map(MapConfig{}),
        update(make_update(config_with(gate_learning),
                           {.adaptive = false, .directional = directional})) {
    std::vector<Eigen::Vector3f> points;
    for (int i = 0; i < 30000; ++i) {
      points.push_back(corridor.point(-kHalfLength, kHalfLength).cast<float>());
    }
    map.insert(points, Eigen::Vector3f::Zero());
    while (truth.x() < 6.0) {
      truth.x() += 0.2;
      Belief belief;
      belief.state.position = truth;
      belief.covariance = 1e-4 * ErrorMatrix::Identity();
      (void)fuse(belief);
    }
  }

  /// The belief after a scan taken at `truth`, level and facing along x.
  Belief fuse(const Belief& predicted, const Belief* leg_free = nullptr) {
    std::vector<Eigen::Vector3f> scan;
    for (int i = 0; i < 800; ++i) {
      const Eigen::Vector3d p = corridor.point(truth.x() - kRange, truth.x() + kRange);
      scan.push_back((p - truth).cast<float>());
    }
    diagnostics = ScanDiagnostics();
    return update.update(predicted, scan, map, diagnostics, leg_free);
  }

  RandomStream random{1, "lidar_update.test"};
  Corridor corridor;
  VoxelMap map;
  LidarUpdate update;
  ScanDiagnostics diagnostics;  ///< of the last scan
  Eigen::Vector3d truth = Eigen::Vector3d::Zero();
};

/// A prediction with an error of 5 cm along every axis, and fully correlated errors of position and
/// leg scale.
Belief correlated_prediction(const Eigen::Vector3d& truth) {
  Belief belief;
  belief.state.position = truth + Eigen::Vector3d::Constant(0.05);
  ErrorVector common = ErrorVector::Zero();
  segment(common, E::kPosition).setConstant(0.1);
  segment(common, E::kLegScale).setConstant(0.1);
  belief.covariance = common * common.transpose() + 1e-4 * ErrorMatrix::Identity();
  return belief;
}

TEST(LidarUpdate, ConsidersTheLegStatesBetweenPlainWallsOnly) {
  EXPECT_TRUE(Sequence(false).update.considers_legs());
  EXPECT_FALSE(Sequence(false, false).update.considers_legs()) << "gating is off";
  EXPECT_FALSE(Sequence(true).update.considers_legs())
      << "pillars constrain the longitudinal direction";
}

TEST(LidarUpdate, PlainWallsCorrectAcrossThemOnly) {
  Sequence sequence(false);
  const Belief predicted = correlated_prediction(sequence.truth);
  const Belief updated = sequence.fuse(predicted);
  EXPECT_LT((updated.state.position - sequence.truth).tail<2>().norm(), 0.015);
  EXPECT_NEAR(updated.state.position.x(), predicted.state.position.x(), 0.005);
  EXPECT_LT((updated.state.leg_scale - predicted.state.leg_scale).norm(), 1e-9);
  const int x = E::kPosition.offset;
  EXPECT_GT(updated.covariance(x, x), 0.8 * predicted.covariance(x, x));
}

TEST(LidarUpdate, JudgesThePredictionOfTheImuByWhatTheScanMakesOfIt) {
  Sequence sequence(true, true, false);
  Belief predicted;
  predicted.state.position = sequence.truth;
  predicted.covariance = 1e-4 * ErrorMatrix::Identity();
  Belief leg_free = predicted;
  leg_free.state.position.y() += 0.05;
  leg_free.covariance *= 2.0;
  (void)sequence.fuse(predicted, &leg_free);
  const ScanDiagnostics with_both = sequence.diagnostics;
  EXPECT_EQ(with_both.C_IL, with_both.C_IL_imu_legs) << "the default";
  EXPECT_GT(with_both.C_IL_imu, 3.0 * with_both.C_IL_imu_legs);

  // The same scan as if the filter itself had predicted so.
  Sequence same(true, true, false);
  (void)same.fuse(leg_free);
  EXPECT_NEAR(with_both.C_IL_imu, same.diagnostics.C_IL_imu_legs,
              0.02 * same.diagnostics.C_IL_imu_legs);
  EXPECT_TRUE(std::isnan(same.diagnostics.C_IL_imu)) << "without that prediction";
}

TEST(LidarUpdate, PillarsCorrectTheLongitudinalDirectionAndTheLegs) {
  Sequence sequence(true);
  const Belief predicted = correlated_prediction(sequence.truth);
  const Belief updated = sequence.fuse(predicted);
  EXPECT_LT((updated.state.position - sequence.truth).norm(), 0.02);
  EXPECT_GT((updated.state.leg_scale - predicted.state.leg_scale).norm(), 0.03);
}

}  // namespace
}  // namespace aims
