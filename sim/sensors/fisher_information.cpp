// SPDX-License-Identifier: BSD-3-Clause
#include "sim/sensors/fisher_information.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <span>

namespace aims {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Pair = Eigen::Array2d;

constexpr double kMinCosine = 1e-3;  ///< of a return at grazing incidence [-]

/// Nominal noise of a range over its own: 1 without noise of its own, 0 without information.
double relative_precision(const ScanTruth& scan, std::size_t i, double nominal_sigma) {
  if (scan.range_sigmas.empty()) return 1.0;
  return nominal_sigma / std::max<double>(scan.range_sigmas[i], kMinRangeSigma);
}

/// A row of the measurement's Jacobian: moment and normal, in world axes.
struct alignas(16) Row {
  std::array<double, 6> values;
};

/// The sum of r^T r over rows r: its upper triangle, two columns at a time.
class OuterSum {
 public:
  OuterSum() { sums_.fill(Pair::Zero()); }

  void add(std::span<const Row> rows) {
    std::array<Pair, kPairs> sums = sums_;  // in registers
    for (const Row& row : rows) {
      const std::array<double, 6>& v = row.values;
      const auto pair = [&v](int i) { return Eigen::Map<const Pair, Eigen::Aligned16>(&v[2 * i]); };
      for (int i = 0; i < 3; ++i) {
        sums[i] += v[0] * pair(i);
        sums[3 + i] += v[1] * pair(i);
      }
      for (int i = 0; i < 2; ++i) {
        sums[6 + i] += v[2] * pair(1 + i);
        sums[8 + i] += v[3] * pair(1 + i);
      }
      sums[10] += v[4] * pair(2);
      sums[11] += v[5] * pair(2);
    }
    sums_ = sums;
  }

  Matrix6 matrix() const {
    constexpr std::array<int, 6> kFirstPair = {0, 3, 5, 7, 8, 9};  // of a row, were it a full one
    Matrix6 full;
    for (int row = 0; row < 6; ++row) {
      for (int column = row; column < 6; ++column) {
        full(row, column) = sums_[kFirstPair[row] + column / 2][column % 2];
        full(column, row) = full(row, column);
      }
    }
    return full;
  }

 private:
  static constexpr std::size_t kPairs = 12;

  std::array<Pair, kPairs> sums_;
};

}  // namespace

ScanInformation scan_information(Time stamp, const ScanTruth& scan, const Pose& T_world_body,
                                 double range_sigma, int first_moving_surface) {
  assert(scan.points.size() == scan.normals.size());
  assert(scan.surfaces.size() == scan.normals.size());
  assert(scan.cosines.size() == scan.normals.size());
  assert(scan.range_sigmas.empty() || scan.range_sigmas.size() == scan.normals.size());
  const double nominal_sigma = std::max(range_sigma, kMinRangeSigma);
  // Summed in world axes about the body's origin, and turned into body axes once.
  OuterSum sum;
  std::array<Row, 64> rows;
  std::size_t count = 0;
  ScanInformation result;
  double relative_information = 0.0;  // of one range: (nominal sigma / its sigma)^2
  for (std::size_t i = 0; i < scan.normals.size(); ++i) {
    if (scan.surfaces[i] >= first_moving_surface) continue;
    const double precision = relative_precision(scan, i, nominal_sigma);
    if (precision == 0.0) continue;
    ++result.returns;
    relative_information += precision * precision;
    const double weight = precision / std::max<double>(scan.cosines[i], kMinCosine);
    const Eigen::Vector3d normal = weight * scan.normals[i].cast<double>();
    const Eigen::Vector3d arm = scan.points[i].cast<double>() - T_world_body.translation;
    const Eigen::Vector3d moment = arm.cross(normal);
    rows[count++] = {{moment.x(), moment.y(), moment.z(), normal.x(), normal.y(), normal.z()}};
    if (count < rows.size()) continue;
    sum.add(rows);
    count = 0;
  }
  sum.add(std::span(rows).first(count));
  const Matrix6 in_world = sum.matrix();
  result.stamp = stamp;
  const double mean = result.returns > 0 ? relative_information / result.returns : 1.0;
  result.range_sigma = nominal_sigma / std::sqrt(mean);
  const double scale = 1.0 / (nominal_sigma * nominal_sigma);
  const Eigen::Matrix3d R = T_world_body.R();
  const Eigen::Matrix3d rotation = in_world.topLeftCorner<3, 3>();
  const Eigen::Matrix3d cross = in_world.topRightCorner<3, 3>();
  const Eigen::Matrix3d translation = in_world.bottomRightCorner<3, 3>();
  Matrix6& J = result.information;
  J.topLeftCorner<3, 3>() = scale * R.transpose() * rotation * R;
  J.topRightCorner<3, 3>() = scale * R.transpose() * cross * R;
  J.bottomRightCorner<3, 3>() = scale * R.transpose() * translation * R;
  J.bottomLeftCorner<3, 3>() = J.topRightCorner<3, 3>().transpose();
  return result;
}

}  // namespace aims
