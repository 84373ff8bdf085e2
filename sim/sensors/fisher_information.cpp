// SPDX-License-Identifier: BSD-3-Clause
#include "sim/sensors/fisher_information.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace aims {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr double kMinCosine = 1e-3;  ///< of a return at grazing incidence [-]

/// Nominal noise of a range over its own: 1 without noise of its own, 0 without information.
double relative_precision(const ScanTruth& scan, std::size_t i, double nominal_sigma) {
  if (scan.range_sigmas.empty()) return 1.0;
  return nominal_sigma / std::max<double>(scan.range_sigmas[i], kMinRangeSigma);
}

}  // namespace

ScanInformation scan_information(Time stamp, const ScanTruth& scan, const Pose& T_world_body,
                                 double range_sigma, int first_moving_surface) {
  assert(scan.points.size() == scan.normals.size());
  assert(scan.surfaces.size() == scan.normals.size());
  assert(scan.cosines.size() == scan.normals.size());
  assert(scan.range_sigmas.empty() || scan.range_sigmas.size() == scan.normals.size());
  const double nominal_sigma = std::max(range_sigma, kMinRangeSigma);
  // Summed in world axes about the body's origin, and turned into body axes once.
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d cross = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d translation = Eigen::Matrix3d::Zero();
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
    rotation.noalias() += moment * moment.transpose();
    cross.noalias() += moment * normal.transpose();
    translation.noalias() += normal * normal.transpose();
  }
  result.stamp = stamp;
  const double mean = result.returns > 0 ? relative_information / result.returns : 1.0;
  result.range_sigma = nominal_sigma / std::sqrt(mean);
  const double scale = 1.0 / (nominal_sigma * nominal_sigma);
  const Eigen::Matrix3d R = T_world_body.R();
  Matrix6& J = result.information;
  J.topLeftCorner<3, 3>() = scale * R.transpose() * rotation * R;
  J.topRightCorner<3, 3>() = scale * R.transpose() * cross * R;
  J.bottomRightCorner<3, 3>() = scale * R.transpose() * translation * R;
  J.bottomLeftCorner<3, 3>() = J.topRightCorner<3, 3>().transpose();
  return result;
}

}  // namespace aims
