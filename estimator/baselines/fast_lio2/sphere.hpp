// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace aims::fast_lio2 {

// The sphere of vectors of one length, on which gravity lies: two tangential coordinates u [rad],
// after Hertzberg, Wagner, Frese, Schroeder (Information Fusion 14, 2013) and He, Xu, Zhang
// (arXiv 2102.03804). `g` is any vector of positive length.

using Matrix32 = Eigen::Matrix<double, 3, 2>;
using Matrix23 = Eigen::Matrix<double, 2, 3>;

/// Two orthonormal columns perpendicular to `g`; smooth but at g along -x, where gravity of a
/// standing robot is not.
Matrix32 sphere_basis(const Eigen::Vector3d& g);

/// g [+] u: `g` turned by the rotation vector B(g) u.
Eigen::Vector3d sphere_plus(const Eigen::Vector3d& g, const Eigen::Vector2d& u);

/// The u with sphere_plus(from, u) = to.
Eigen::Vector2d sphere_minus(const Eigen::Vector3d& to, const Eigen::Vector3d& from);

/// Derivative of sphere_minus(y, g) in y at y = g: a change of the vector in tangential
/// coordinates.
Matrix23 sphere_minus_jacobian(const Eigen::Vector3d& g);

/// Derivative of sphere_plus(g, u) in u.
Matrix32 sphere_plus_jacobian(const Eigen::Vector3d& g, const Eigen::Vector2d& u);

}  // namespace aims::fast_lio2
