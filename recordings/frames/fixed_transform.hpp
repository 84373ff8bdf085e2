// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <string_view>

#include "core/error.hpp"
#include "core/lie.hpp"

namespace aims {

/// A fixed transform between two named frames, whichever format it was written in.
struct FixedTransform {
  std::string parent;
  std::string child;
  Pose T_parent_child;
};

/// A rotation of nine numbers, row by row. Rounded decimals are made orthonormal. Errors begin with
/// `place` and name the determinant or the deviation from orthonormality.
Result<Eigen::Quaterniond> rotation_of_matrix(std::span<const double> row_major,
                                              std::string_view place);

/// A rotation of a quaternion x, y, z, w of norm 1, but for rounding.
Result<Eigen::Quaterniond> rotation_of_quaternion(std::span<const double> xyzw,
                                                  std::string_view place);

/// R = Rz(yaw) Ry(pitch) Rx(roll) [rad].
Eigen::Quaterniond rotation_of_rpy(double roll, double pitch, double yaw);

/// A rigid transform of 16 numbers (4x4) or 12 (its first three rows), row by row; translations in
/// units of `metres`.
Result<Pose> pose_of_matrix(std::span<const double> row_major, std::string_view place,
                            double metres = 1.0);

/// A translation [m]: finite and below 100 m, beyond which it is likely in millimetres.
Result<Eigen::Vector3d> translation_of(std::span<const double> xyz, std::string_view place);

}  // namespace aims
