// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <limits>

namespace aims::points {

/// How planes constrain the translation of a scan; NaN without a plane.
struct TranslationConstraint {
  double smallest = std::numeric_limits<double>::quiet_NaN();   ///< eigenvalue of N^T N [-]
  double condition = std::numeric_limits<double>::quiet_NaN();  ///< largest over smallest [-]
  /// Sum of the cosines between normals and the weakest direction, those above cos 80 degrees
  /// (after X-ICP, Tuna et al. 2023) [-].
  double localizability = std::numeric_limits<double>::quiet_NaN();
};

/// The constraint by planes whose unit normals are the rows of `normals`.
TranslationConstraint translation_constraint(
    const Eigen::Ref<const Eigen::Matrix<double, Eigen::Dynamic, 3>>& normals);

}  // namespace aims::points
