// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "estimator/filter/error_state.hpp"

namespace aims {

/// Information of a block with the other block, of information `other`, unknown: the Schur
/// complement of `other`; `cross` is the off-diagonal block, 3x3 each.
Eigen::Matrix3d schur_complement(const Eigen::Matrix3d& block, const Eigen::Matrix3d& cross,
                                 const Eigen::Matrix3d& other);

/// Information about the position with the rotation unknown.
Eigen::Matrix3d position_information(const Matrix6& information);

}  // namespace aims
