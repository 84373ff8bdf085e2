// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/aims/lidar_update.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include "core/random.hpp"
#include "estimator/aims/presets.hpp"

namespace aims {
namespace {

using E = ErrorState;

constexpr double kHalfLength = 15.0;  // of the corridor [m]
constexpr double kHalfWidth = 1.2;    // of a square cross-section [m]
constexpr double kRange = 6.0;        // of the LiDAR [m]
constexpr double kNoise = 0.01;       // of a return [m]

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
void fill(VoxelMap& map, Corridor& corridor, double from, double to) {
  for (std::size_t half = 0; half < kHalves; ++half) {
    std::vector<Eigen::Vector3f> points;
    for (int i = 0; i < 30000; ++i) points.push_back(corridor.point(from, to).cast<float>());
    map.insert(points, Eigen::Vector3f::Zero());
  }
}

/// The LiDAR update of `preset` with `part` of each scan, after 6 m along a corridor with a known
/// map.
struct Sequence {
  explicit Sequence(bool pillars, std::string_view preset = "aims_d", double taper = 0.0,
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
  EXPECT_FALSE(Sequence(false, "tfs_plus").update.considers_legs()) << "without cross-validation";
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

// Walls that draw nearer by 7.5 mrad show where the robot is. Where noise helps to map, a map shows
// as much by itself.
TEST(LidarUpdate, MoreTiltIsFreeWhileAllInformationIsTaken) {
  constexpr double kTaper = 0.0075;  // [rad]
  EXPECT_FALSE(Sequence(false, "aims_d", kTaper, ScanPart::kReal).update.considers_legs());
  EXPECT_TRUE(Sequence(false, "aims_d", kTaper, ScanPart::kAll).update.considers_legs());
}

// Between plain walls the noise of the map holds a belief where it is predicted to be.
TEST(LidarUpdate, AllInformationContainsThatOfNoise) {
  Sequence sequence(false);
  const Belief predicted = correlated_prediction(sequence.truth);
  const Belief updated = sequence.fuse(predicted, ScanPart::kAll);
  const int x = E::kPosition.offset;
  EXPECT_LT(updated.covariance(x, x), 0.5 * predicted.covariance(x, x));
  EXPECT_GT((updated.state.leg_scale - predicted.state.leg_scale).norm(), 1e-4);
}

// The scan is 20 mrad off, and attitude and mount are as uncertain as each other.
TEST(LidarUpdate, AScanThatTurnsTheMountTooLiesInTheMap) {
  for (const ScanPart part : {ScanPart::kAll, ScanPart::kReal}) {
    Sequence sequence(true);
    Belief predicted;
    predicted.state.position = sequence.truth;
    predicted.state.rotation = so3_exp({0.0, 0.0, 0.02});
    predicted.covariance = 1e-6 * ErrorMatrix::Identity();
    block(predicted.covariance, E::kRotation, E::kRotation) = 9e-4 * Eigen::Matrix3d::Identity();
    block(predicted.covariance, E::kMount, E::kMount) = 9e-4 * Eigen::Matrix3d::Identity();
    const NominalState updated = sequence.fuse(predicted, part).state;
    EXPECT_NEAR(so3_log(updated.rotation).z(), 0.01, 1e-3);
    EXPECT_NEAR(so3_log(updated.mount).z(), -0.01, 1e-3);
    EXPECT_LT(so3_log(scan_pose(updated, CalibrationModel()).rotation).norm(), 1e-3);
  }
}

// The estimate may be far from the belief that maps: between plain walls that changes nothing of
// what the real part of a scan does to it; between pillars the scan takes it to the other one.
TEST(LidarUpdate, TheRealPartActsWhereTheScanWasMatched) {
  for (const bool pillars : {false, true}) {
    Sequence sequence(pillars);
    Belief predicted = correlated_prediction(sequence.truth);
    block(predicted.covariance, E::kPosition, E::kPosition) += 4.0 * Eigen::Matrix3d::Identity();
    (void)sequence.fuse(predicted, ScanPart::kAll);
    predicted.state.position.x() += 2.0;
    const Belief updated = sequence.update.update_with_real_part(predicted, sequence.map);
    EXPECT_LT((updated.state.position - sequence.truth).tail<2>().norm(), 0.02);
    const double x = updated.state.position.x() - sequence.truth.x();
    EXPECT_NEAR(x, pillars ? 0.0 : 2.05, 0.03);
  }
}

// A leg sample whose model of the scale is off by a percent, after a distance over which the
// scale has made the position uncertain by metres: the gain along x is 0.1 m per m/s then, and 200
// samples a second would carry the position away. What position and velocity have in common
// besides, of the last moments, does correct it.
TEST(LidarUpdate, BetweenPlainWallsLegsCorrectThePositionAsIfTheirScaleWereKnown) {
  const Sequence sequence(false);
  Belief belief;
  ErrorVector common = ErrorVector::Zero();
  common(E::kPosition.offset) = -3.0;
  common(E::kVelocity.offset) = -0.09;
  common(E::kLegScale.offset) = 0.12;
  belief.covariance = common * common.transpose() + 1e-4 * ErrorMatrix::Identity();
  belief.covariance.diagonal().segment<E::kLegSize>(E::kLegScale.offset).array() += 1e-8 - 1e-4;
  LinearMeasurement legs;
  legs.residual = Eigen::Vector3d(0.05, 0.05, 0.0);
  columns(legs.jacobian, E::kVelocity).setIdentity();
  columns(legs.jacobian, E::kLegScale) = Eigen::Vector3d(0.73, 0.0, 0.0).asDiagonal();
  legs.noise = 0.01 * Eigen::Matrix3d::Identity();
  const double plain = fuse(belief, legs).state.position.x();
  EXPECT_GT(std::abs(plain), 0.005) << "the scale has something to do";
  const Belief updated = sequence.update.fuse_velocity(belief, legs);
  EXPECT_LT(std::abs(updated.state.position.x()), 1e-3);
  EXPECT_LT(updated.state.leg_scale.norm(), 1e-12);
  EXPECT_NE(updated.state.velocity.y(), 0.0);

  const double recent = 5e-5;
  belief.covariance(E::kPosition.offset, E::kVelocity.offset) += recent;
  belief.covariance(E::kVelocity.offset, E::kPosition.offset) += recent;
  const double moved = sequence.update.fuse_velocity(belief, legs).state.position.x();
  EXPECT_NEAR(moved - updated.state.position.x(), -recent * 0.05 / 0.0101, 5e-6);

  const Sequence constrained(true);
  for (const GainMask& mask : {GainMask(), GainMask{.legs = false}}) {
    EXPECT_EQ(constrained.update.fuse_velocity(belief, legs, mask).covariance,
              fuse(belief, legs, mask).covariance)
        << "pillars constrain x";
  }
}

TEST(LidarUpdate, JudgesThePredictionOfTheImuByWhatTheScanMakesOfIt) {
  Sequence sequence(true, "aims");
  Belief predicted;
  predicted.state.position = sequence.truth;
  predicted.covariance = 1e-4 * ErrorMatrix::Identity();
  Belief leg_free = predicted;
  leg_free.state.position.y() += 0.05;
  leg_free.covariance *= 2.0;
  (void)sequence.fuse(predicted, ScanPart::kReal, &leg_free);
  const ScanDiagnostics with_both = sequence.diagnostics;
  EXPECT_EQ(with_both.C_IL, with_both.C_IL_imu) << "the paper's reading is the default";
  EXPECT_GT(with_both.C_IL_imu, 3.0 * with_both.C_IL_imu_legs);

  // The same scan as if the filter itself had predicted so.
  Sequence same(true, "aims");
  (void)same.fuse(leg_free);
  EXPECT_NEAR(with_both.C_IL_imu, same.diagnostics.C_IL_imu_legs,
              0.02 * same.diagnostics.C_IL_imu_legs);
  EXPECT_TRUE(std::isnan(same.diagnostics.C_IL_imu)) << "without that prediction";
  EXPECT_EQ(same.diagnostics.C_IL, same.diagnostics.C_IL_imu_legs) << "what there is";
}

TEST(LidarUpdate, PillarsCorrectTheLongitudinalDirectionAndTheLegs) {
  Sequence sequence(true);
  const Belief predicted = correlated_prediction(sequence.truth);
  const Belief updated = sequence.fuse(predicted);
  EXPECT_LT((updated.state.position - sequence.truth).norm(), 0.02);
  EXPECT_GT((updated.state.leg_scale - predicted.state.leg_scale).norm(), 0.03);
}

// After seconds without scans the attitude is far off. A step there fits the planes that happen to
// lie where the prediction puts the points.
TEST(LidarUpdate, FindsBackFromAPredictionThatIsFarOff) {
  for (const std::string_view preset : {"aims_d", "lio"}) {
    Sequence sequence(true, preset);
    const int usual = sequence.diagnostics.points_used;
    Belief predicted;
    predicted.state.position = sequence.truth + Eigen::Vector3d(0.1, 0.1, -0.1);
    predicted.state.rotation = so3_exp({-0.05, 0.3, -0.05});
    predicted.covariance = 1e-6 * ErrorMatrix::Identity();
    block(predicted.covariance, E::kRotation, E::kRotation) = 9e-4 * Eigen::Matrix3d::Identity();
    block(predicted.covariance, E::kPosition, E::kPosition) = 0.01 * Eigen::Matrix3d::Identity();
    const Belief updated = sequence.fuse(predicted);
    EXPECT_LT(so3_log(updated.state.rotation).norm(), 0.003) << preset;
    EXPECT_LT((updated.state.position - sequence.truth).norm(), 0.005) << preset;
    EXPECT_GT(sequence.diagnostics.points_used, 0.9 * usual) << preset;
    EXPECT_GT(sequence.diagnostics.iterations, eskf_preset(preset).lidar.max_iterations);
  }
}

/// A point of a face across the corridor at `x`.
Eigen::Vector3d on_face(double x, RandomStream& random) {
  return Eigen::Vector3d(x, kHalfWidth * (2.0 * random.uniform() - 1.0),
                         kHalfWidth * (2.0 * random.uniform() - 1.0)) +
         kNoise * random.normal3();
}

/// What a scan made of its prediction.
struct FaceScan {
  double error = 0.0;  ///< of the position along the corridor afterwards [m]
  bool relocated = false;
};

/// What a scan of which 20 of 800 returns lie on a face `seen` ahead of where the robot was makes
/// of a prediction that is `drift` too far along the corridor, with a deviation of `sigma`, while
/// the map has a face `mapped` ahead [m]. Of five scans, over which the robot walks on by 0.2 m
/// each, the first that is matched elsewhere, or the last one.
FaceScan fuse_with_faces(Sequence& sequence, double mapped, double seen, double drift, double sigma,
                         ScanPart part) {
  RandomStream& random = sequence.random;
  const double start = sequence.truth.x();
  for (int i = 0; i < 60; ++i) {  // enough for both halves
    std::vector<Eigen::Vector3f> face;
    for (int k = 0; k < 100; ++k) face.push_back(on_face(start + mapped, random).cast<float>());
    sequence.map.insert(face, Eigen::Vector3f::Zero());
  }
  FaceScan result;
  for (int scans = 0; scans < 5 && !result.relocated; ++scans) {
    sequence.truth.x() += 0.2;
    std::vector<Eigen::Vector3f> scan;
    const auto add = [&](const Eigen::Vector3d& p) {
      scan.push_back((p - sequence.truth).cast<float>());
    };
    for (int i = 0; i < 780; ++i) {
      add(sequence.corridor.point(start + 1.0 - kRange, start + std::min(mapped, seen)));
    }
    for (int i = 0; i < 20; ++i) add(on_face(start + seen, random));
    Belief predicted;
    predicted.state.position = sequence.truth + drift * Eigen::Vector3d::UnitX();
    predicted.covariance = 1e-4 * ErrorMatrix::Identity();
    predicted.covariance(E::kPosition.offset, E::kPosition.offset) = sigma * sigma;
    sequence.diagnostics = ScanDiagnostics();
    const Belief updated = sequence.update.update(predicted, scan, sequence.map, CalibrationModel(),
                                                  part, sequence.diagnostics);
    result = {updated.state.position.x() - sequence.truth.x(), sequence.diagnostics.relocated};
  }
  return result;
}

// A robot that comes back with a drift larger than a residual may be has no match with the end
// wall.
TEST(LidarUpdate, FindsAnEndWallAlongItsDrift) {
  for (const ScanPart part : {ScanPart::kAll, ScanPart::kReal}) {
    for (const double drift : {-0.6, -0.35, 0.35, 1.0}) {
      Sequence sequence(false);
      const FaceScan scan = fuse_with_faces(sequence, 5.0, 5.0, drift, std::abs(drift), part);
      EXPECT_TRUE(scan.relocated) << drift << " m";
      EXPECT_NEAR(scan.error, 0.0, 0.1 * std::abs(drift)) << drift << " m";
    }
  }
}

TEST(LidarUpdate, SearchesOnlyWhereItsPredictionMayBe) {
  Sequence sequence(false);
  EXPECT_FALSE(fuse_with_faces(sequence, 5.0, 5.0, 0.6, 0.15, ScanPart::kReal).relocated);
}

// The back of a pillar is met on the way back only. At the offset that puts it onto the front,
// which the map has, fewer of the other returns match.
TEST(LidarUpdate, StaysWhereMoreOfTheScanMatches) {
  Sequence sequence(true);
  const FaceScan scan = fuse_with_faces(sequence, 4.3, 5.0, 0.0, 0.5, ScanPart::kReal);
  EXPECT_FALSE(scan.relocated);
  EXPECT_NEAR(scan.error, 0.0, 0.02);
}

/// Returns near one wall of a plain corridor: seven of nine 0.196 m outside it, two as far inside.
/// Millimetres towards the seven, and the residual gate takes those two away.
std::vector<Eigen::Vector3f> returns_about_a_wall(int count) {
  std::vector<Eigen::Vector3f> scan;
  for (int i = 0; i < count; ++i) {
    const float offset = 7 * i % 9 < 7 ? 0.196F : -0.196F;
    scan.emplace_back(-2.0F + 0.4F * static_cast<float>(i % 10),
                      static_cast<float>(kHalfWidth) + offset,
                      -0.8F + 0.2F * static_cast<float>(i / 10));
  }
  return scan;
}

TEST(LidarUpdate, IsRefusedWhenItsLastLinearizationHasTooFewPlanes) {
  RandomStream random(1, "last_linearization");
  Corridor corridor(0.0, random);
  VoxelMap map(MapConfig{});
  fill(map, corridor, -5.0, 5.0);
  Belief predicted;
  predicted.covariance = 1e-6 * ErrorMatrix::Identity();
  block(predicted.covariance, E::kPosition, E::kPosition) = 2e-5 * Eigen::Matrix3d::Identity();
  const auto update = [&](int count) {
    EskfConfig config = eskf_preset("tfs_clean");
    config.lidar.max_iterations = 1;
    ScanDiagnostics diagnostics;
    const Belief belief = LidarUpdate(config).update(predicted, returns_about_a_wall(count), map,
                                                     {}, ScanPart::kReal, diagnostics);
    EXPECT_EQ(boxminus(belief.state, predicted.state).isZero(0.0), diagnostics.iterations == 0);
    return diagnostics;
  };
  const ScanDiagnostics fused = update(80);
  EXPECT_EQ(fused.iterations, 2);
  ASSERT_GE(fused.points_used, 40);
  ASSERT_LE(fused.points_used, 70) << "the gate took returns away";
  const ScanDiagnostics refused = update(36);
  EXPECT_LT(refused.points_used, kMinMatches) << "the gate left 28 of 36";
  EXPECT_EQ(refused.iterations, 0);
}

/// One scan against a noisy map of a corridor with shallow faces, from a prediction whose error
/// along the corridor is drawn from its covariance; squared error after the update over its stated
/// variance. Every point has an error of its own.
double normalised_error_along(double facing, std::uint64_t seed) {
  RandomStream random(seed, "wall_and_recess");
  Corridor corridor(facing, random);
  EskfConfig config = eskf_preset("aims_d");
  config.robust_kernel.enabled = false;
  config.lidar.correlated_points = 1.0;
  VoxelMap map(MapConfig{});
  fill(map, corridor, -3.0, 3.0);
  LidarUpdate update(config);
  const auto fuse = [&](const Eigen::Vector3d& truth, const Belief& predicted) {
    std::vector<Eigen::Vector3f> scan;
    for (int i = 0; i < 300; ++i) {
      scan.push_back((corridor.point(-2.8, 2.8) - truth).cast<float>());
    }
    ScanDiagnostics diagnostics;
    return update.update(predicted, scan, map, {}, ScanPart::kReal, diagnostics);
  };
  Belief belief;
  belief.covariance = 1e-6 * ErrorMatrix::Identity();
  for (double x = -2.5; x < -0.03; x += 0.05) {  // learns the noise
    belief.state.position.x() = x;
    (void)fuse(belief.state.position, belief);
  }
  constexpr double kSigma = 0.01;  // of the prediction along the corridor [m]
  const int x = E::kPosition.offset;
  belief.state.position.setZero();
  belief.covariance(x, x) = kSigma * kSigma;
  const Eigen::Vector3d truth(kSigma * random.normal(), 0.0, 0.0);
  const Belief updated = fuse(truth, belief);
  const double error = updated.state.position.x() - truth.x();
  return error * error / updated.covariance(x, x);
}

TEST(LidarUpdate, TheStatedVarianceIsTheRealOneBetweenWallsWithFaces) {
  constexpr int kDraws = 100;
  for (const double facing : {0.0, 0.01, 0.03}) {
    double sum = 0.0;
    for (int draw = 0; draw < kDraws; ++draw) {
      sum += normalised_error_along(facing, static_cast<std::uint64_t>(1000 + draw));
    }
    // 100 draws: 99.9 % of chi-square lies within 0.60 and 1.50.
    EXPECT_GT(sum / kDraws, 0.60) << "faces " << facing << ", seeds 1000 to 1099";
    EXPECT_LT(sum / kDraws, 1.50) << "faces " << facing << ", seeds 1000 to 1099";
  }
}

}  // namespace
}  // namespace aims
