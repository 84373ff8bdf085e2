// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

#include "core/scan_information.hpp"
#include "core/trajectory.hpp"

namespace aims {

/// The information about three of the pose's six parameters when the other three are unknown too
/// (the Schur complement), by its axes.
struct BlockInformation {
  Eigen::Vector3d eigenvalues = Eigen::Vector3d::Zero();  ///< ascending; 0: no information
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();     ///< unit columns, body axes

  /// Axis with the smallest eigenvalue.
  Eigen::Vector3d weak_axis() const { return axes.col(0); }
};

/// Translation information [1/m^2] that remains when the rotation is unknown. Eigenvalues below
/// 1e-9 of the sum's largest are rounding and count as zero.
BlockInformation translation_information(const Eigen::Matrix<double, 6, 6>& information);

/// Rotation information [1/rad^2] that remains when the translation is unknown.
BlockInformation rotation_information(const Eigen::Matrix<double, 6, 6>& information);

/// Cramer-Rao bound of one parameter: 1 / sqrt(information), infinite without information.
double bound_of(double information);

/// Localizability of one scan: its information about the pose, from the ground truth.
struct Localizability {
  Time stamp = 0;  ///< true end of the scan
  int returns = 0;
  double lambda_min = 0.0;  ///< smallest eigenvalue of the translation information [1/m^2]
  /// Number of perpendicular returns with the same information along the weak axis:
  /// lambda_min sigma^2.
  double equivalent_returns = 0.0;
  double sigma = std::numeric_limits<double>::infinity();         ///< Cramer-Rao bound along it [m]
  Eigen::Vector3d weak_axis_in_body = Eigen::Vector3d::UnitX();   ///< unit; its sign means nothing
  Eigen::Vector3d weak_axis_in_world = Eigen::Vector3d::UnitX();  ///< the same by the true pose
  double rotation_lambda_min = 0.0;  ///< of the rotation information [1/rad^2]
  double rotation_sigma = std::numeric_limits<double>::infinity();  ///< [rad]
};

/// Localizability of a scan taken at the true pose `T_world_body` of its end.
Localizability localizability_of(const ScanInformation& scan, const Pose& T_world_body);

/// Localizability of every scan inside the span of the true trajectory.
std::vector<Localizability> localizability_of(std::span<const ScanInformation> scans,
                                              const Trajectory& truth);

/// A limit below which a scan counts as degenerate.
struct DegeneracyLevel {
  std::string_view name;
  double equivalent_returns;  ///< fewer are degenerate
};

/// The limits in use, smallest first.
inline constexpr std::array<DegeneracyLevel, 3> kDegeneracyLevels = {
    {{"n10", 10.0}, {"n100", 100.0}, {"n1000", 1000.0}}};

/// True when the scan has fewer equivalent returns along its weak axis than the limit.
bool is_degenerate(const Localizability& scan, const DegeneracyLevel& level);

}  // namespace aims
