// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace aims::points {

/// Three entries of an error vector, from a block's first on.
template <int kSize>
auto part(Eigen::Matrix<double, kSize, 1>& vector, int block) {
  return vector.template segment<3>(block);
}
template <int kSize>
auto part(const Eigen::Matrix<double, kSize, 1>& vector, int block) {
  return vector.template segment<3>(block);
}

/// The 3x3 block of two blocks of three entries.
template <int kSize>
auto part(Eigen::Matrix<double, kSize, kSize>& matrix, int row, int column) {
  return matrix.template block<3, 3>(row, column);
}
template <int kSize>
auto part(const Eigen::Matrix<double, kSize, kSize>& matrix, int row, int column) {
  return matrix.template block<3, 3>(row, column);
}

}  // namespace aims::points
