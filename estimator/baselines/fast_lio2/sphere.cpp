// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/fast_lio2/sphere.hpp"

#include <cmath>
#include <numbers>

#include "core/lie.hpp"

namespace aims::fast_lio2 {
namespace {

/// Sines and remainders below this are zero [-].
constexpr double kTiny = 1e-11;

}  // namespace

Matrix32 sphere_basis(const Eigen::Vector3d& g) {
  const Eigen::Vector3d n = g.normalized();
  Matrix32 basis;
  if (1.0 + n.x() < kTiny) {
    basis << 0.0, 0.0, -1.0, 0.0, 0.0, 1.0;
    return basis;
  }
  // The rotation that takes the x axis to n, applied to the y and the z axis.
  const double scale = 1.0 / (1.0 + n.x());
  basis << -n.y(), -n.z(),                                  //
      1.0 - n.y() * n.y() * scale, -n.y() * n.z() * scale,  //
      -n.y() * n.z() * scale, 1.0 - n.z() * n.z() * scale;
  return basis;
}

Eigen::Vector3d sphere_plus(const Eigen::Vector3d& g, const Eigen::Vector2d& u) {
  return so3_exp(sphere_basis(g) * u) * g;
}

Eigen::Vector2d sphere_minus(const Eigen::Vector3d& to, const Eigen::Vector3d& from) {
  const Eigen::Vector3d axis = from.cross(to);
  const double sine = axis.norm();
  const double cosine = from.dot(to);
  const double scale = from.norm() * to.norm();
  if (sine < kTiny * scale) {
    // Opposite vectors: any axis of the tangential plane, by half a turn.
    return cosine > 0.0 ? Eigen::Vector2d::Zero() : Eigen::Vector2d(std::numbers::pi, 0.0);
  }
  return std::atan2(sine, cosine) / sine * (sphere_basis(from).transpose() * axis);
}

Matrix23 sphere_minus_jacobian(const Eigen::Vector3d& g) {
  return sphere_basis(g).transpose() * hat(g) / g.squaredNorm();
}

Matrix32 sphere_plus_jacobian(const Eigen::Vector3d& g, const Eigen::Vector2d& u) {
  const Matrix32 basis = sphere_basis(g);
  const Eigen::Vector3d phi = basis * u;
  return -so3_exp(phi).toRotationMatrix() * hat(g) * so3_right_jacobian(phi) * basis;
}

}  // namespace aims::fast_lio2
