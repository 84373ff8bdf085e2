// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/frames/fixed_transform.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

namespace aims {
namespace {

constexpr double kRounding = 0.01;   ///< of entries, and of a norm that is 1
constexpr double kFarthest = 100.0;  ///< between sensors of one robot [m]

using Rows = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

}  // namespace

Result<Eigen::Quaterniond> rotation_of_matrix(std::span<const double> row_major,
                                              std::string_view place) {
  if (row_major.size() != 9) {
    return failure(fmt::format("{}: expected 9 numbers, a rotation matrix row by row, found {}",
                               place, row_major.size()));
  }
  const Eigen::Matrix3d R = Eigen::Map<const Rows>(row_major.data());
  const double off = (R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(off < kRounding)) {
    return failure(fmt::format(
        "{}: expected a rotation matrix; its columns are no unit vectors at right angles (off by "
        "{:.3g})",
        place, off));
  }
  if (R.determinant() < 0.0) {
    return failure(
        fmt::format("{}: expected a rotation matrix of determinant +1, found -1: one "
                    "axis is mirrored",
                    place));
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(R, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return Eigen::Quaterniond(Eigen::Matrix3d(svd.matrixU() * svd.matrixV().transpose()))
      .normalized();
}

Result<Eigen::Quaterniond> rotation_of_quaternion(std::span<const double> xyzw,
                                                  std::string_view place) {
  if (xyzw.size() != 4) {
    return failure(
        fmt::format("{}: expected a quaternion x, y, z, w, found {} numbers", place, xyzw.size()));
  }
  const Eigen::Quaterniond q(xyzw[3], xyzw[0], xyzw[1], xyzw[2]);
  if (!(std::abs(q.norm() - 1.0) < kRounding)) {
    return failure(
        fmt::format("{}: expected a unit quaternion, found one of norm {:.4g}", place, q.norm()));
  }
  return q.normalized();
}

Eigen::Quaterniond rotation_of_rpy(double roll, double pitch, double yaw) {
  const Eigen::Quaterniond about_x(Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()));
  const Eigen::Quaterniond about_y(Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()));
  return yaw_rotation(yaw) * about_y * about_x;
}

Result<Eigen::Vector3d> translation_of(std::span<const double> xyz, std::string_view place) {
  const bool good = xyz.size() == 3 && std::ranges::all_of(xyz, [](double each) {
                      return std::abs(each) <= kFarthest;
                    });
  if (!good) {
    return failure(
        fmt::format("{}: expected a translation of three numbers in metres, at most 100", place));
  }
  return Eigen::Vector3d(xyz[0], xyz[1], xyz[2]);
}

Result<Pose> pose_of_matrix(std::span<const double> row_major, std::string_view place,
                            double metres) {
  const bool whole = row_major.size() == 16;
  if (!whole && row_major.size() != 12) {
    return failure(
        fmt::format("{}: expected 16 numbers, a matrix 4x4 row by row, or 12, its first "
                    "three rows; found {}",
                    place, row_major.size()));
  }
  if (whole) {
    const Eigen::Map<const Eigen::RowVector4d> last(row_major.data() + 12);
    if (!((last - Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0)).norm() < 1e-6)) {
      return failure(fmt::format("{}: expected 0 0 0 1 as the last row", place));
    }
  }
  std::array<double, 9> rotation{};
  std::array<double, 3> translation{};
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column) {
      rotation[3 * row + column] = row_major[4 * row + column];
    }
    translation[row] = metres * row_major[4 * row + 3];
  }
  const auto R = rotation_of_matrix(rotation, place);
  if (!R) return tl::unexpected(R.error());
  const auto t = translation_of(translation, place);
  if (!t) return tl::unexpected(t.error());
  return Pose{*R, *t};
}

}  // namespace aims
