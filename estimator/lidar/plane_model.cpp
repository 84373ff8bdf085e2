// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/lidar/plane_model.hpp"

#include <algorithm>
#include <cmath>
#ifdef __SSE2__
#include <emmintrin.h>
#endif

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
constexpr double kNewtonTolerance = 1e-12;

/// One number for each half: one instruction takes both.
using Both = double __attribute__((vector_size(16)));
static_assert(sizeof(Both) == kHalves * sizeof(double));

Both larger_of_each(Both a, Both b) { return a > b ? a : b; }

Both root_of_each(Both a) {
#ifdef __SSE2__
  return _mm_sqrt_pd(a);
#else
  return Both{std::sqrt(a[0]), std::sqrt(a[1])};
#endif
}

struct Vector3Both {
  Both x{};
  Both y{};
  Both z{};

  Vector3Both minus(const Vector3Both& o) const { return {x - o.x, y - o.y, z - o.z}; }
  Vector3Both times(Both factor) const { return {x * factor, y * factor, z * factor}; }
  Both dot(const Vector3Both& o) const { return x * o.x + y * o.y + z * o.z; }
  Vector3Both cross(const Vector3Both& o) const {
    return {y * o.z - z * o.y, z * o.x - x * o.z, x * o.y - y * o.x};
  }
};

/// Of each half, the longer vector.
Vector3Both longer(const Vector3Both& a, const Vector3Both& b) {
  const auto first = a.dot(a) >= b.dot(b);
  return {first ? a.x : b.x, first ? a.y : b.y, first ? a.z : b.z};
}

struct SymmetricBoth {
  Both xx{};
  Both xy{};
  Both xz{};
  Both yy{};
  Both yz{};
  Both zz{};

  void add_square(const Vector3Both& d) {
    xx += d.x * d.x;
    xy += d.x * d.y;
    xz += d.x * d.z;
    yy += d.y * d.y;
    yz += d.y * d.z;
    zz += d.z * d.z;
  }
  Both trace() const { return xx + yy + zz; }
  /// Sum of the principal minors of two rows.
  Both minors() const { return xx * yy - xy * xy + xx * zz - xz * xz + yy * zz - yz * yz; }
  Both determinant() const {
    return xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz);
  }
};

/// The smallest eigenvalue, its unit eigenvector, and the second eigenvalue.
struct SmallestEigenpair {
  Both value{};
  Both second{};
  Vector3Both vector;
};

/// Of a symmetric positive semi-definite `A`. Newton's method on the characteristic polynomial
/// grows from zero to its smallest root without passing it. The vector is not finite where the two
/// smallest eigenvalues are equal.
SmallestEigenpair smallest_eigenpair(const SymmetricBoth& A) {
  const Both trace = A.trace();
  const Both minors = A.minors();
  const Both determinant = A.determinant();
  SmallestEigenpair pair;
  for (int i = 0; i < kNewtonSteps; ++i) {
    const Both x = pair.value;
    const Both slope = minors + x * (3.0 * x - 2.0 * trace);
    const Both step = (determinant - x * (minors + x * (x - trace))) / slope;
    const auto grows = step > kNewtonTolerance * trace;
    pair.value += grows ? step : Both{};
    if (grows[0] == 0 && grows[1] == 0) break;
  }
  // The other two from their sum and product.
  const Both half_sum = 0.5 * (trace - pair.value);
  const Both product = minors - pair.value * (trace - pair.value);
  pair.second = half_sum - root_of_each(larger_of_each(half_sum * half_sum - product, Both{}));
  const Vector3Both a{A.xx - pair.value, A.xy, A.xz};
  const Vector3Both b{A.xy, A.yy - pair.value, A.yz};
  const Vector3Both c{A.xz, A.yz, A.zz - pair.value};
  const Vector3Both normal = longer(longer(a.cross(b), b.cross(c)), c.cross(a));
  pair.vector = normal.times(1.0 / root_of_each(normal.dot(normal)));
  return pair;
}

/// Coordinates relative to `origin`, so that floats of a large map lose nothing in sums.
std::array<Vector3Both, kPlanePoints> relative(const std::array<PlanePoints, kHalves>& points,
                                               const Eigen::Vector3f& origin) {
  std::array<Vector3Both, kPlanePoints> result;
  for (std::size_t i = 0; i < kPlanePoints; ++i) {
    const Eigen::Vector3d a = (points[0][i] - origin).cast<double>();
    const Eigen::Vector3d b = (points[1][i] - origin).cast<double>();
    result[i] = {Both{a.x(), b.x()}, Both{a.y(), b.y()}, Both{a.z(), b.z()}};
  }
  return result;
}

/// Whether the origin lies among the `points` of a plane with this normal and mean.
auto origin_lies_among(const std::array<Vector3Both, kPlanePoints>& points,
                       const Vector3Both& normal, const Vector3Both& mean) {
  const Both across = normal.dot(mean);
  // From the mean to the origin, within the plane; of any length.
  const Vector3Both offset = normal.times(across).minus(mean);
  Both squares{};
  for (const Vector3Both& p : points) {
    const Both along = offset.dot(p.minus(mean));
    squares += along * along;
  }
  const Both square = offset.dot(offset);
  return static_cast<double>(kPlanePoints) * square * square <= kMaxOffset * kMaxOffset * squares;
}

}  // namespace

PlanePair fit_planes(const std::array<PlanePoints, kHalves>& points, const Eigen::Vector3f& query) {
  const std::array<Vector3Both, kPlanePoints> at = relative(points, query);
  constexpr double kShare = 1.0 / static_cast<double>(kPlanePoints);
  Vector3Both mean;
  for (const Vector3Both& p : at) mean = {mean.x + p.x, mean.y + p.y, mean.z + p.z};
  mean = mean.times(Both{kShare, kShare});
  SymmetricBoth scatter;
  for (const Vector3Both& p : at) scatter.add_square(p.minus(mean));
  // Deviations times the root of their number.
  const SmallestEigenpair smallest = smallest_eigenpair(scatter);
  const Both second = kShare * smallest.second;
  const auto valid =
      (second >= kMinSpread * kMinSpread) & (smallest.second >= kMinRatio * smallest.value) &
      (smallest.vector.dot(smallest.vector) > 0.5) & origin_lies_among(at, smallest.vector, mean);
  Both thickness{};
  for (const Vector3Both& p : at) {
    const Both distance = smallest.vector.dot(p.minus(mean));
    thickness = larger_of_each(thickness, larger_of_each(distance, -distance));
  }
  const auto plane = [&](std::size_t half) {
    const auto number = [half](Both both) { return both[half]; };
    const Eigen::Vector3d offset(number(mean.x), number(mean.y), number(mean.z));
    return Plane{{number(smallest.vector.x), number(smallest.vector.y), number(smallest.vector.z)},
                 query.cast<double>() + offset,
                 valid[half] != 0,
                 number(thickness)};
  };
  return {plane(0), plane(1)};
}

}  // namespace aims
