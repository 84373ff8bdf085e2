// SPDX-License-Identifier: BSD-3-Clause
#include "sim/sensors/fisher_information.hpp"

#include <algorithm>
#include <cassert>

namespace aims {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr double kMinCosine = 1e-3;  ///< of a return at grazing incidence [-]

}  // namespace

ScanInformation scan_information(Time stamp, const ScanTruth& scan, const Pose& T_world_body,
                                 double range_sigma, int first_moving_surface) {
  assert(scan.points.size() == scan.normals.size());
  assert(scan.surfaces.size() == scan.normals.size());
  assert(scan.cosines.size() == scan.normals.size());
  // Summed in world axes about the body's origin, and turned into body axes once.
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d cross = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d translation = Eigen::Matrix3d::Zero();
  ScanInformation result;
  for (std::size_t i = 0; i < scan.normals.size(); ++i) {
    if (scan.surfaces[i] >= first_moving_surface) continue;
    ++result.returns;
    const double weight = 1.0 / std::max<double>(scan.cosines[i], kMinCosine);
    const Eigen::Vector3d normal = weight * scan.normals[i].cast<double>();
    const Eigen::Vector3d arm = scan.points[i].cast<double>() - T_world_body.translation;
    const Eigen::Vector3d moment = arm.cross(normal);
    rotation.noalias() += moment * moment.transpose();
    cross.noalias() += moment * normal.transpose();
    translation.noalias() += normal * normal.transpose();
  }
  result.stamp = stamp;
  result.range_sigma = std::max(range_sigma, kMinRangeSigma);
  const double scale = 1.0 / (result.range_sigma * result.range_sigma);
  const Eigen::Matrix3d R = T_world_body.R();
  Matrix6& J = result.information;
  J.topLeftCorner<3, 3>() = scale * R.transpose() * rotation * R;
  J.topRightCorner<3, 3>() = scale * R.transpose() * cross * R;
  J.bottomRightCorner<3, 3>() = scale * R.transpose() * translation * R;
  J.bottomLeftCorner<3, 3>() = J.topRightCorner<3, 3>().transpose();
  return result;
}

}  // namespace aims
