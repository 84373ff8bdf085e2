// SPDX-License-Identifier: BSD-3-Clause
#include "bench/metrics/unknown_map_bound.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <map>

#include "tests/bench/metrics/bound_motions.hpp"

namespace aims {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using testing::certain;
using testing::curved_motion;
using testing::straight_motion;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr double kScanStep = 0.1;  ///< [s]

/// A plane of the map: its offset along the normal is unknown.
struct Plane {
  Vector3d point;
  Vector3d normal;
};

/// Planes, and scans every 0.1 s of a body that moves along x at 0.5 m/s without turning.
struct Problem {
  std::vector<Plane> planes;
  double seconds = 8.0;
  double reach = 1.5;          ///< from which a plane is seen [m]
  double plane_sigma = 0.01;   ///< of one scan about one plane [m]
  BoundParameters parameters;  ///< without legs, biases and leg scale

  Vector3d position(int scan) const { return {0.5 * kScanStep * scan, 0.0, 0.0}; }
  int scans() const { return static_cast<int>(std::lround(seconds / kScanStep)); }
  bool sees(int scan, const Plane& plane) const {
    return (plane.point - position(scan)).norm() < reach;
  }
  /// Jacobian of the distance to the plane in rotation and translation of the body.
  Vector6 row(int scan, const Plane& plane) const {
    Vector6 h;
    h << (plane.point - position(scan)).cross(plane.normal), plane.normal;
    return h;
  }
};

std::vector<PosteriorBound> bounds_of(const Problem& problem) {
  std::vector<ScanView> views;
  for (int k = 1; k <= problem.scans(); ++k) {
    ScanView view{from_seconds(kScanStep * k), {}};
    for (std::size_t j = 0; j < problem.planes.size(); ++j) {
      if (!problem.sees(k, problem.planes[j])) continue;
      const Vector6 h = problem.row(k, problem.planes[j]);
      view.parts.push_back(
          {static_cast<int>(j), h * h.transpose() / std::pow(problem.plane_sigma, 2)});
    }
    views.push_back(view);
  }
  std::vector<Vector3d> centres;
  for (const Plane& each : problem.planes) centres.push_back(each.point);
  return unknown_map_bounds(straight_motion(problem.seconds, 0.5), views, centres,
                            problem.parameters);
}

/// Rotation, position and velocity of every scan and the offset of every plane in one matrix.
class Batch {
 public:
  explicit Batch(const Problem& problem, int last)
      : problem_(problem), last_(last), information_(size(), size()) {
    information_.setZero();
    add_prior();
    for (int k = 1; k <= last_; ++k) add_step(k);
    for (int k = 1; k <= last_; ++k) add_scan(k);
  }

  /// Covariance of the last position, by inversion of the whole.
  Eigen::Matrix3d position() const {
    const MatrixXd covariance = information_.inverse();
    return covariance.block<3, 3>(9 * last_ + 3, 9 * last_ + 3);
  }

 private:
  Eigen::Index size() const {
    return 9 * (last_ + 1) + static_cast<Eigen::Index>(problem_.planes.size());
  }

  void add(const MatrixXd& rows, const MatrixXd& noise) {
    information_ += rows.transpose() * noise.inverse() * rows;
  }

  void add_prior() {
    const InitialKnowledge& known = problem_.parameters.initial;
    VectorXd variance(9);
    variance << known.tilt_sigma, known.tilt_sigma, known.heading_sigma,
        Vector3d::Constant(known.position_sigma),
        Vector3d::Constant(1.0);  // the start moves: its speed is unknown
    MatrixXd rows = MatrixXd::Zero(9, size());
    rows.leftCols(9).setIdentity();
    add(rows, variance.cwiseAbs2().asDiagonal().toDenseMatrix());
  }

  void add_step(int k) {
    const double dt = kScanStep;
    const double force = std::pow(problem_.parameters.accelerometer.noise_density, 2);
    const double turn = std::pow(problem_.parameters.gyro.noise_density, 2);
    const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
    const Eigen::Matrix3d tilted = -hat(Vector3d(0.0, 0.0, 9.81));
    MatrixXd F = MatrixXd::Identity(9, 9);
    F.block<3, 3>(6, 0) = dt * tilted;
    F.block<3, 3>(3, 0) = 0.5 * dt * dt * tilted;
    F.block<3, 3>(3, 6) = dt * I;
    MatrixXd Q = MatrixXd::Zero(9, 9);
    Q.block<3, 3>(0, 0) = turn * dt * I;
    Q.block<3, 3>(3, 3) = force * dt * dt * dt / 3.0 * I;
    Q.block<3, 3>(3, 6) = Q.block<3, 3>(6, 3) = force * dt * dt / 2.0 * I;
    Q.block<3, 3>(6, 6) = force * dt * I;
    MatrixXd rows = MatrixXd::Zero(9, size());
    rows.middleCols(9 * k, 9).setIdentity();
    rows.middleCols(9 * (k - 1), 9) = -F;
    add(rows, Q);
  }

  void add_scan(int k) {
    for (std::size_t j = 0; j < problem_.planes.size(); ++j) {
      const auto offset = 9 * (last_ + 1) + static_cast<Eigen::Index>(j);
      information_(offset, offset) += 1e-9;  // a plane that is never seen
      if (!problem_.sees(k, problem_.planes[j])) continue;
      MatrixXd row = MatrixXd::Zero(1, size());
      row.middleCols(9 * k, 6) = problem_.row(k, problem_.planes[j]).transpose();
      row(0, offset) = -1.0;
      add(row, MatrixXd::Constant(1, 1, std::pow(problem_.plane_sigma, 2)));
    }
  }

  const Problem& problem_;
  int last_;
  MatrixXd information_;
};

void expect_bounds_of_the_batch(const Problem& problem, int axes) {
  const auto bounds = bounds_of(problem);
  ASSERT_EQ(bounds.size(), static_cast<std::size_t>(problem.scans()));
  for (const int k : {1, 7, 20, 35, problem.scans()}) {
    const Eigen::Matrix3d expected = Batch(problem, k).position();
    const Eigen::Matrix3d found = bounds[static_cast<std::size_t>(k - 1)].position;
    for (int i = 0; i < axes; ++i) {
      EXPECT_NEAR(std::sqrt(found(i, i) / expected(i, i)), 1.0, 0.02) << "scan " << k << ", " << i;
    }
    EXPECT_LT((found - expected).topLeftCorner(axes, axes).norm(), 0.04 * expected.norm());
  }
}

/// Planes across a line, each seen over 3 m: each hands the error on to the next.
TEST(UnknownMapBound, IsThatOfABatchOverPlanesOnALine) {
  Problem problem;
  problem.parameters = certain();
  problem.parameters.accelerometer.noise_density = 0.05;
  problem.parameters.gyro.noise_density = 1e-6;
  problem.parameters.initial = {1e-5, 1e-6, 1e-6, 1e-2};
  for (int j = 0; j < 6; ++j) problem.planes.push_back({{0.8 * j, 0.0, 0.0}, Vector3d::UnitX()});
  expect_bounds_of_the_batch(problem, 1);
}

/// Walls of several directions about a line, with unknown attitude: what a plane gives depends on
/// where it is seen from.
TEST(UnknownMapBound, IsThatOfABatchOverWallsInAPlane) {
  Problem problem;
  problem.parameters = certain();
  problem.parameters.initial = {1e-4, 1e-3, 1e-2, 1e-2};
  problem.parameters.accelerometer.noise_density = 0.05;
  problem.parameters.gyro.noise_density = 0.01;
  for (int j = 0; j < 8; ++j) {
    const double angle = 0.9 * j;
    problem.planes.push_back(
        {{0.6 * j, j % 2 == 0 ? 0.7 : -0.6, 0.1 * j}, {std::cos(angle), std::sin(angle), 0.0}});
  }
  expect_bounds_of_the_batch(problem, 2);
}

BoundParameters walking() {
  BoundParameters p;
  p.gyro = {2e-4, 2e-5, 2e-3};
  p.accelerometer = {1.5e-3, 2e-4, 0.03};
  return p;
}

Matrix6 well_seen() { return Matrix6::Identity() / (0.005 * 0.005); }

/// Views every 0.1 s whose information comes from the part that `part_of` names.
template <class PartOf>
std::vector<ScanView> views_of(double seconds, PartOf part_of) {
  std::vector<ScanView> views;
  for (int k = 1; k <= std::lround(seconds / kScanStep); ++k) {
    views.push_back({from_seconds(kScanStep * k), {{part_of(k), well_seen()}}});
  }
  return views;
}

void expect_equal(const std::vector<PosteriorBound>& found,
                  const std::vector<PosteriorBound>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 4; i < found.size(); i += 5) {
    EXPECT_NEAR(found[i].longitudinal / expected[i].longitudinal, 1.0, 0.02) << i;
    EXPECT_NEAR(found[i].lateral / expected[i].lateral, 1.0, 0.02) << i;
    EXPECT_NEAR(found[i].vertical / expected[i].vertical, 1.0, 0.02) << i;
    EXPECT_NEAR(found[i].heading / expected[i].heading, 1.0, 0.02) << i;
  }
}

std::vector<ScanInformation> scans_of(const std::vector<ScanView>& views) {
  std::vector<ScanInformation> scans;
  for (const ScanView& each : views)
    scans.push_back({each.stamp, each.parts[0].information, 1, 0.02});
  return scans;
}

TEST(UnknownMapBound, OfAKnownMapIsThePosteriorBound) {
  const auto motion = curved_motion(6.0);
  const auto views = views_of(6.0, [](int) { return kKnownPart; });
  expect_equal(unknown_map_bounds(motion, views, {}, walking()),
               posterior_bounds(motion, scans_of(views), walking()));
}

TEST(UnknownMapBound, OfAMapThatAPerfectScanMadeAtTheStartIsThatOfAKnownMap) {
  const auto motion = curved_motion(6.0);
  auto views = views_of(6.0, [](int) { return 0; });
  const auto scans = scans_of(views);
  views.insert(views.begin(), {0, {{0, 1e4 * well_seen()}}});
  BoundParameters parameters = walking();
  parameters.initial.tilt_sigma = 1e-5;
  parameters.initial.position_sigma = parameters.initial.heading_sigma = 1e-6;
  auto found =
      unknown_map_bounds(motion, views, std::vector<Vector3d>(1, Vector3d(2, 1, 0)), parameters);
  found.erase(found.begin());
  expect_equal(found, posterior_bounds(motion, scans, parameters));
}

TEST(UnknownMapBound, WithoutCommonSurfacesIsDeadReckoning) {
  const auto motion = curved_motion(6.0);
  const auto views = views_of(6.0, [](int k) { return k - 1; });
  BoundParameters alone = walking();
  alone.lidar = false;
  expect_equal(
      unknown_map_bounds(motion, views, std::vector<Vector3d>(60, Vector3d::Zero()), walking()),
      posterior_bounds(motion, scans_of(views), alone));
}

/// The map is that of the start on the way back, so that the error is too.
TEST(UnknownMapBound, FallsWhenTheMapOfTheStartIsSeenAgain) {
  const auto motion = curved_motion(8.0);
  std::vector<Vector3d> centres(4, Vector3d::Zero());
  const auto away = views_of(8.0, [](int k) { return std::min(k / 20, 3); });
  const auto back = views_of(8.0, [](int k) { return k == 80 ? 0 : std::min(k / 20, 3); });
  const double drifted = unknown_map_bounds(motion, away, centres, walking()).back().longitudinal;
  const double closed = unknown_map_bounds(motion, back, centres, walking()).back().longitudinal;
  EXPECT_LT(closed, 0.8 * drifted);
}

}  // namespace
}  // namespace aims
