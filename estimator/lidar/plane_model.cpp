// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/lidar/plane_model.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

namespace aims {
namespace {

/// Smallest second principal deviation of the points of a plane: the jamb of a door 15 cm deep has
/// 4.3 cm (docs/decisions.md) [m].
constexpr double kMinSpread = 0.05;

/// Smallest ratio of the second to the smallest principal variance; docs/decisions.md.
constexpr double kMinRatio = 10.0;

/// Largest distance of a return from the mean of the points of its plane, in their deviations.
constexpr double kMaxOffset = 1.5;

/// Steps of Newton's method at most, and the step that ends it, relative to the trace.
constexpr int kNewtonSteps = 20;
constexpr double kNewtonTolerance = 1e-15;

/// The smallest eigenvalue, its unit eigenvector, and the second eigenvalue.
struct SmallestEigenpair {
  double value = 0.0;
  double second = 0.0;
  Eigen::Vector3d vector;
};

/// Of a symmetric positive semi-definite `A`. Newton's method on the characteristic polynomial
/// grows from zero to its smallest root without passing it. The vector is not finite where the two
/// smallest eigenvalues are equal.
SmallestEigenpair smallest_eigenpair(const Eigen::Matrix3d& A) {
  const double trace = A.trace();
  const double minors = A(0, 0) * A(1, 1) - A(0, 1) * A(0, 1) + A(0, 0) * A(2, 2) -
                        A(0, 2) * A(0, 2) + A(1, 1) * A(2, 2) - A(1, 2) * A(1, 2);
  const double determinant = A.determinant();
  SmallestEigenpair pair;
  for (int i = 0; i < kNewtonSteps; ++i) {
    const double x = pair.value;
    const double slope = minors + x * (3.0 * x - 2.0 * trace);
    const double step = (determinant - x * (minors + x * (x - trace))) / slope;
    if (!(step > kNewtonTolerance * trace)) break;
    pair.value += step;
  }
  // The other two from their sum and product.
  const double half_sum = 0.5 * (trace - pair.value);
  const double product = minors - pair.value * (trace - pair.value);
  pair.second = half_sum - std::sqrt(std::max(half_sum * half_sum - product, 0.0));
  const Eigen::Matrix3d B = A - pair.value * Eigen::Matrix3d::Identity();
  const std::array<Eigen::Vector3d, 3> normals = {
      B.col(0).cross(B.col(1)), B.col(1).cross(B.col(2)), B.col(2).cross(B.col(0))};
  const auto longer = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return a.squaredNorm() < b.squaredNorm();
  };
  const Eigen::Vector3d& longest = *std::max_element(normals.begin(), normals.end(), longer);
  pair.vector = longest / longest.norm();
  return pair;
}

}  // namespace

Plane fit_plane(std::span<const Eigen::Vector3f> points) {
  if (points.size() < 3) return {};
  const auto count = static_cast<double>(points.size());
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3f& p : points) mean += p.cast<double>();
  mean /= count;
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3f& p : points) {
    const Eigen::Vector3d d = p.cast<double>() - mean;
    scatter.noalias() += d * d.transpose();
  }
  scatter /= count;
  const SmallestEigenpair smallest = smallest_eigenpair(scatter);
  Plane plane;
  plane.point = mean;
  plane.normal = smallest.vector;
  plane.valid = plane.normal.allFinite() && smallest.second >= kMinSpread * kMinSpread &&
                smallest.second >= kMinRatio * smallest.value;
  if (!plane.valid) return plane;
  for (const Eigen::Vector3f& p : points) {
    const double distance = plane.normal.dot(p.cast<double>() - plane.point);
    plane.thickness = std::max(plane.thickness, std::abs(distance));
  }
  return plane;
}

bool lies_among(std::span<const Eigen::Vector3f> points, const Plane& plane,
                const Eigen::Vector3f& query) {
  Eigen::Vector3d offset = query.cast<double>() - plane.point;
  offset -= plane.normal.dot(offset) * plane.normal;
  // Of the projections on `offset`, which is not of unit length.
  double squares = 0.0;
  for (const Eigen::Vector3f& p : points) {
    const double along = offset.dot(p.cast<double>() - plane.point);
    squares += along * along;
  }
  const double square = offset.squaredNorm();
  return static_cast<double>(points.size()) * square * square <= kMaxOffset * kMaxOffset * squares;
}

}  // namespace aims
