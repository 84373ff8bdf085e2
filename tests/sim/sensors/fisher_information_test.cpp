// SPDX-License-Identifier: BSD-3-Clause
#include "sim/sensors/fisher_information.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "sim/environment/ray_caster.hpp"
#include "sim/environment/scene_config.hpp"
#include "sim/simulation.hpp"

namespace aims {
namespace {

using Eigen::Vector3d;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

constexpr double kSigma = 0.02;

/// A coarse sensor that sees everything, with range noise alone.
LidarConfig coarse_lidar() {
  LidarConfig config;
  config.columns = 24;
  config.range_sigma = kSigma;
  config.miss_probability = 0.0;
  config.range_at_10_percent = 1e4;
  config.body_mask_min = config.body_mask_max = Vector3d::Zero();
  return config;
}

Solid box(const Vector3d& center, const Vector3d& half_extents) {
  Solid solid;
  solid.T_world_solid.translation = center;
  solid.half_extents = half_extents;
  return solid;
}

Scene room(double length, double width) {
  Scene scene;
  scene.floor.min_corner = {-length, -width};
  scene.floor.max_corner = {length, width};
  scene.solids = {box({0, 0, 3.5}, {length, width, 0.5}),
                  box({0, 0.5 * width + 0.5, 1.5}, {length, 0.5, 2}),
                  box({0, -0.5 * width - 0.5, 1.5}, {length, 0.5, 2}),
                  box({0.5 * length + 0.5, 0, 1.5}, {0.5, width, 2}),
                  box({-0.5 * length - 0.5, 0, 1.5}, {0.5, width, 2})};
  return scene;
}

/// A room with a little furniture, its walls a few metres away all around.
Scene rich_room() {
  Scene scene = room(9.0, 7.0);
  Solid cupboard = box({2.0, 2.4, 0.6}, {0.5, 0.3, 0.6});
  cupboard.T_world_solid.rotation = yaw_rotation(0.5);
  scene.solids.push_back(cupboard);
  return scene;
}

/// Walls along x that go on farther than the sensor sees.
Scene endless_corridor() { return room(2000.0, 2.2); }

Pose viewpoint() { return {so3_exp({0.02, -0.03, 0.4}), {0.3, -0.2, 0.5}}; }

/// A beam of a real scan and the plane that it truly meets.
struct Beam {
  Vector3d origin;     ///< of the beam, in the body [m]
  Vector3d direction;  ///< unit, in the body
  Vector3d normal;     ///< of the surface, world
  double offset;       ///< normal . x of the surface's points [m]
  double range;        ///< measured [m]
};

/// One noisy scan from a standing sensor, as beams and true planes.
std::vector<Beam> beams_of(const LidarScan& scan, const ScanTruth& seen) {
  std::vector<Beam> beams;
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const Vector3d p = scan.points[i].position.cast<double>();
    const Vector3d n = seen.normals[i].cast<double>();
    beams.push_back(
        {Vector3d::Zero(), p.normalized(), n, n.dot(seen.points[i].cast<double>()), p.norm()});
  }
  return beams;
}

/// Least squares of the ranges over the pose by Gauss-Newton from `start`, with prior information
/// about that start. Independent of the formula under test: derivatives are differences.
Pose register_ranges(const std::vector<Beam>& beams, const Pose& start, const Matrix6& prior) {
  const auto predicted = [](const Beam& beam, const Pose& pose) {
    const Vector3d direction = pose.rotation * beam.direction;
    return (beam.offset - beam.normal.dot(pose * beam.origin)) / beam.normal.dot(direction);
  };
  const auto moved = [](const Pose& pose, const Vector6& by) {
    return pose * Pose{so3_exp(by.head<3>()), by.tail<3>()};
  };
  Pose pose = start;
  Vector6 from_start = Vector6::Zero();
  for (int iteration = 0; iteration < 4; ++iteration) {
    Matrix6 A = prior;
    Vector6 b = -prior * from_start;
    for (const Beam& beam : beams) {
      Vector6 gradient;
      for (int i = 0; i < 6; ++i) {
        const Vector6 step = 1e-5 * Vector6::Unit(i);
        gradient[i] =
            (predicted(beam, moved(pose, step)) - predicted(beam, moved(pose, -step))) / 2e-5;
      }
      A += gradient * gradient.transpose() / (kSigma * kSigma);
      b += gradient * (beam.range - predicted(beam, pose)) / (kSigma * kSigma);
    }
    const Vector6 step = A.ldlt().solve(b);
    pose = moved(pose, step);
    from_start += step;
  }
  return pose;
}

Matrix6 prior_information(double rotation_sigma, double translation_sigma) {
  Vector6 inverse_variance;
  inverse_variance << Vector3d::Constant(1.0 / (rotation_sigma * rotation_sigma)),
      Vector3d::Constant(1.0 / (translation_sigma * translation_sigma));
  return inverse_variance.asDiagonal();
}

/// Errors (rotation, translation; body axes) of registered scans and the information they had.
struct Spread {
  Matrix6 covariance = Matrix6::Zero();  ///< of the errors about the truth
  Matrix6 information = Matrix6::Zero();
};

Spread spread_of_registrations(const Scene& scene, const LidarConfig& config, int draws,
                               const Matrix6& prior) {
  const RayCaster caster(scene);
  const Pose truth = viewpoint();
  Lidar lidar(config, caster, 5);
  RandomStream random(5, "test.prior");
  const Matrix6 prior_root =
      Matrix6(prior.llt().matrixL()).transpose().inverse();  // of the prior's covariance
  Spread spread;
  for (int draw = 0; draw < draws; ++draw) {
    ScanTruth seen;
    const LidarScan scan = lidar.scan(0, {{0, truth}}, &seen);
    Vector6 off;
    for (double& each : off) each = random.normal();
    off = prior_root * off;
    const Pose start = truth * Pose{so3_exp(off.head<3>()), off.tail<3>()};
    const Pose found = register_ranges(beams_of(scan, seen), start, prior);
    const Pose error = truth.inverse() * found;
    Vector6 e;
    e << so3_log(error.rotation), error.translation;
    spread.covariance += e * e.transpose() / draws;
    if (draw == 0) spread.information = scan_information(0, seen, truth, kSigma).information;
  }
  return spread;
}

TEST(ScanInformation, OneFacingReturnInformsByItsInverseVarianceAlongItsNormal) {
  ScanTruth hits;
  hits.points = {{5.0F, 0.0F, 0.0F}};
  hits.normals = {{-1.0F, 0.0F, 0.0F}};
  hits.cosines = {1.0F};
  hits.surfaces = {0};
  const ScanInformation scan = scan_information(7, hits, Pose{}, 0.1);
  Matrix6 expected = Matrix6::Zero();
  expected(3, 3) = 100.0;
  EXPECT_TRUE(scan.information.isApprox(expected, 1e-9)) << scan.information;
  EXPECT_EQ(scan.stamp, 7);
  EXPECT_EQ(scan.returns, 1);
}

TEST(ScanInformation, EqualsTheFiniteDifferencesOfTheRangesThatTheSceneGives) {
  const Scene scene = rich_room();
  const RayCaster caster(scene);
  LidarConfig config = coarse_lidar();
  config.range_sigma = 0.0;
  Lidar lidar(config, caster, 1);
  // The sensor sits beside the body's origin, and both turn within the scan.
  const Pose T_body_lidar{so3_exp({0.0, 0.1, 0.2}), {0.1, -0.05, 0.2}};
  Trajectory motion;
  for (int i = 0; i <= 40; ++i) {
    const double t = 0.0025 * i;
    const Pose body{so3_exp({0.02, 0.3 * t, 0.4 + 0.5 * t}), {0.3 + 0.8 * t, -0.2, 0.5}};
    motion.push_back({from_seconds(t), body * T_body_lidar});
  }
  ScanTruth seen;
  const LidarScan scan = lidar.scan(0, motion, &seen);
  const Pose end = motion.back().pose * T_body_lidar.inverse();
  Matrix6 expected = Matrix6::Zero();
  ScanTruth kept;
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const Pose at = *pose_at(motion, scan.points[i].time_offset_ns);
    const Vector3d beam = scan.points[i].position.cast<double>().normalized();
    const auto range_at = [&](const Vector6& by) -> std::optional<double> {
      const Pose shifted = end * Pose{so3_exp(by.head<3>()), by.tail<3>()} * end.inverse() * at;
      const auto hit = caster.cast(shifted.translation, shifted.rotation * beam);
      if (!hit || (hit->normal - seen.normals[i].cast<double>()).norm() > 1e-3) return std::nullopt;
      return hit->distance;
    };
    Vector6 gradient;
    bool one_surface = true;  // no edge lies between the shifted beams
    for (int axis = 0; axis < 6; ++axis) {
      const auto plus = range_at(1e-3 * Vector6::Unit(axis));
      const auto minus = range_at(-1e-3 * Vector6::Unit(axis));
      one_surface = one_surface && plus && minus;
      if (one_surface) gradient[axis] = (*plus - *minus) / 2e-3;
    }
    if (!one_surface) continue;
    expected += gradient * gradient.transpose() / (kSigma * kSigma);
    kept.points.push_back(seen.points[i]);
    kept.normals.push_back(seen.normals[i]);
    kept.cosines.push_back(seen.cosines[i]);
    kept.surfaces.push_back(seen.surfaces[i]);
  }
  ASSERT_GT(kept.points.size(), scan.points.size() * 9 / 10);
  const Matrix6 computed = scan_information(0, kept, end, kSigma).information;
  EXPECT_TRUE(computed.isApprox(expected, 5e-3)) << computed << "\n\n" << expected;
}

/// Deviation along a world axis of a covariance of the translation in body axes.
double deviation_along(const Vector3d& axis, const Matrix6& covariance) {
  const Vector3d in_body = viewpoint().rotation.conjugate() * axis;
  return std::sqrt(in_body.dot(covariance.bottomRightCorner<3, 3>() * in_body));
}

TEST(ScanInformation, BoundsTheSpreadOfRegisteredScansInARichRoomOnEveryAxis) {
  const int draws = 1000;  // sampling error of a deviation: 2.2 %
  const Matrix6 prior = prior_information(0.02, 0.1);
  const Spread spread = spread_of_registrations(rich_room(), coarse_lidar(), draws, prior);
  const Matrix6 bound = (spread.information + prior).inverse();
  for (int i = 0; i < 6; ++i) {
    const double ratio = std::sqrt(spread.covariance(i, i) / bound(i, i));
    EXPECT_NEAR(ratio, 1.0, 0.1) << "axis " << i << ", bound " << std::sqrt(bound(i, i));
  }
  EXPECT_LT(std::sqrt(bound(3, 3)), 0.01) << "the room fixes the place";
}

TEST(ScanInformation, LeavesTheSpreadAtThePriorAlongTheFreeAxisOfAnEndlessCorridor) {
  const double prior_sigma = 0.3;
  LidarConfig config = coarse_lidar();
  config.range_max = 30.0;
  const Spread spread = spread_of_registrations(endless_corridor(), config, 800,
                                                prior_information(0.02, prior_sigma));
  EXPECT_NEAR(deviation_along(Vector3d::UnitX(), spread.covariance), prior_sigma,
              0.1 * prior_sigma);
  EXPECT_LT(deviation_along(Vector3d::UnitY(), spread.covariance), 0.01);
  const Vector3d along = viewpoint().rotation.conjugate() * Vector3d::UnitX();
  EXPECT_LT(along.dot(spread.information.bottomRightCorner<3, 3>() * along), 1e-3);
}

TEST(ScanInformation, BoundsTheSpreadWithinFifteenPercentAlongAWeaklyObservedAxis) {
  Scene scene = endless_corridor();
  scene.solids.push_back(box({10.0, 0.0, 1.5}, {0.05, 0.3, 2.0}));  // one pillar ahead
  LidarConfig config = coarse_lidar();
  config.columns = 150;
  config.rings = 4;
  config.elevation_min_deg = -4.0;
  config.elevation_max_deg = 4.0;
  config.range_max = 30.0;
  // Beams graze the walls at 2 deg: the start must be nearer than that for Gauss-Newton to
  // converge.
  const Matrix6 prior = prior_information(0.002, 0.3);
  const Spread spread = spread_of_registrations(scene, config, 500, prior);
  const double bound = deviation_along(Vector3d::UnitX(), (spread.information + prior).inverse());
  EXPECT_GT(bound, 0.004);
  EXPECT_LT(bound, 0.05);
  EXPECT_NEAR(deviation_along(Vector3d::UnitX(), spread.covariance) / bound, 1.0, 0.15)
      << "bound " << bound;
}

TEST(ScanInformation, LeavesOutMovingSurfaces) {
  ScanTruth hits;
  hits.points = {{5.0F, 0.0F, 0.0F}, {3.0F, 0.5F, 0.1F}};
  hits.normals = {{-1.0F, 0.0F, 0.0F}, {-0.8F, 0.6F, 0.0F}};
  hits.cosines = {1.0F, 0.9F};
  hits.surfaces = {3, 7};
  EXPECT_EQ(scan_information(0, hits, Pose{}, 0.1).returns, 2);
  const ScanInformation scan = scan_information(0, hits, Pose{}, 0.1, 7);
  EXPECT_EQ(scan.returns, 1);
  EXPECT_DOUBLE_EQ(scan.information.bottomRightCorner(3, 3).trace(), 100.0);
}

TEST(ScanInformation, WeighsEveryReturnByItsOwnNoise) {
  ScanTruth hits;
  hits.points.assign(3, {5.0F, 0.0F, 0.0F});
  hits.normals.assign(3, {-1.0F, 0.0F, 0.0F});
  hits.cosines.assign(3, 1.0F);
  hits.surfaces.assign(3, 0);
  hits.range_sigmas = {0.1F, 0.2F, std::numeric_limits<float>::infinity()};
  const ScanInformation scan = scan_information(0, hits, Pose{}, 0.05);
  EXPECT_EQ(scan.returns, 2) << "infinite noise is no return";
  EXPECT_NEAR(scan.information(3, 3), 100.0 + 25.0, 1e-4);
  EXPECT_NEAR(scan.range_sigma, 1.0 / std::sqrt(0.5 * (100.0 + 25.0)), 1e-8);
  hits.range_sigmas.assign(3, 0.05F);
  const ScanInformation same = scan_information(0, hits, Pose{}, 0.05);
  hits.range_sigmas.clear();
  EXPECT_TRUE(same.information.isApprox(scan_information(0, hits, Pose{}, 0.05).information, 1e-6));
}

TEST(ScanInformation, OfAScanWithoutReturnsIsZero) {
  const ScanInformation scan = scan_information(0, {}, Pose{}, 0.0);
  EXPECT_TRUE(scan.information.isZero());
  EXPECT_EQ(scan.range_sigma, kMinRangeSigma);
}

TEST(SimulatedTruth, HoldsTheInformationOfEveryDeliveredScan) {
  SimulationConfig config;
  config.scene.corridor.length = 10.0;
  config.route.points = {{"a", 0.0, 0.0}, {"b", 2.0, 0.0}};
  config.max_duration = 3.0;
  config.lidar.columns = 64;
  config.links.lidar.loss = 0.3;
  Simulation simulation = Simulation::create(config, 1).value();
  std::vector<Delivery> deliveries;
  while (simulation.advance(kSecond, deliveries)) {
  }
  std::vector<std::pair<Time, int>> delivered;
  for (const Delivery& each : deliveries) {
    if (const auto* scan = std::get_if<LidarScanPtr>(&each.measurement)) {
      delivered.emplace_back((*scan)->end, static_cast<int>((*scan)->points.size()));
    }
  }
  std::vector<std::pair<Time, int>> recorded;
  for (const ScanInformation& scan : simulation.truth().scans) {
    recorded.emplace_back(scan.stamp, scan.returns);
    const Eigen::SelfAdjointEigenSolver<Matrix6> solver(scan.information);
    EXPECT_GT(solver.eigenvalues()(0), 0.0);
    EXPECT_EQ(scan.range_sigma, config.lidar.range_sigma);
  }
  EXPECT_EQ(recorded, delivered);
  EXPECT_LT(recorded.size(), 29U);
  EXPECT_GT(recorded.size(), 10U);
}

// Beams along the normal of a wall with h = a sin(k x): each tells of x by its slope over the
// noise, (a k cos(k x) / sigma)^2, and whole waves of N beams have N (a k)^2 / (2 sigma^2).
TEST(FisherInformation, OfASinusoidalReliefIsTheSumOfItsSquaredSlopes) {
  constexpr int kBeams = 4000;
  constexpr double kAmplitude = 0.002;  // [m]
  constexpr double kWaves = 25.0;
  constexpr double kLength = 40.0;  // [m]
  const double wavenumber = 2.0 * std::numbers::pi * kWaves / kLength;
  ScanTruth scan;
  for (int i = 0; i < kBeams; ++i) {
    const double x = kLength * i / kBeams;
    const double slope = kAmplitude * wavenumber * std::cos(wavenumber * x);
    const Vector3d normal = Vector3d(-slope, -1.0, 0.0).normalized();
    scan.points.push_back(Vector3d(x, 2.0, 0.0).cast<float>());
    scan.normals.push_back(normal.cast<float>());
    scan.cosines.push_back(static_cast<float>(-normal.y()));
    scan.surfaces.push_back(0);
  }
  const ScanInformation result = scan_information(0, scan, {}, kSigma);
  const double expected = kBeams * std::pow(kAmplitude * wavenumber, 2) / (2.0 * kSigma * kSigma);
  EXPECT_NEAR(result.information(3, 3), expected, 1e-4 * expected);
}

}  // namespace
}  // namespace aims
