// SPDX-License-Identifier: BSD-3-Clause
#include "core/lie.hpp"

#include <cmath>
#include <numbers>

namespace aims {
namespace {

/// Below this angle [rad] closed forms lose digits and the Taylor series is exact to double.
constexpr double kSmallAngle = 1e-4;

}  // namespace

Eigen::Matrix3d hat(const Eigen::Vector3d& a) {
  Eigen::Matrix3d m;
  m << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0;
  return m;
}

Eigen::Quaterniond so3_exp(const Eigen::Vector3d& phi) {
  const double angle = phi.norm();
  const double half = 0.5 * angle;
  const double sinc_half =
      angle < kSmallAngle ? 0.5 * (1.0 - half * half / 6.0) : std::sin(half) / angle;
  Eigen::Quaterniond q;
  q.w() = std::cos(half);
  q.vec() = sinc_half * phi;
  return q.normalized();
}

Eigen::Vector3d so3_log(const Eigen::Quaterniond& q) {
  const double sign = q.w() < 0.0 ? -1.0 : 1.0;
  const Eigen::Vector3d v = sign * q.vec();
  const double w = sign * q.w();
  const double n = v.norm();
  if (n < kSmallAngle) return (2.0 / w) * (1.0 - n * n / (3.0 * w * w)) * v;
  return (2.0 * std::atan2(n, w) / n) * v;
}

Eigen::Matrix3d so3_right_jacobian(const Eigen::Vector3d& phi) {
  const double angle = phi.norm();
  const Eigen::Matrix3d K = hat(phi);
  if (angle < kSmallAngle) return Eigen::Matrix3d::Identity() - 0.5 * K + K * K / 6.0;
  const double angle2 = angle * angle;
  return Eigen::Matrix3d::Identity() - (1.0 - std::cos(angle)) / angle2 * K +
         (angle - std::sin(angle)) / (angle2 * angle) * K * K;
}

Eigen::Matrix3d so3_right_jacobian_inverse(const Eigen::Vector3d& phi) {
  const double angle = phi.norm();
  const Eigen::Matrix3d K = hat(phi);
  if (angle < kSmallAngle) return Eigen::Matrix3d::Identity() + 0.5 * K + K * K / 12.0;
  const double half = 0.5 * angle;
  const double factor = (1.0 - half / std::tan(half)) / (angle * angle);
  return Eigen::Matrix3d::Identity() + 0.5 * K + factor * K * K;
}

Eigen::Quaterniond yaw_rotation(double yaw) { return so3_exp(yaw * Eigen::Vector3d::UnitZ()); }

double yaw_of(const Eigen::Quaterniond& q) {
  const Eigen::Vector3d forward = q * Eigen::Vector3d::UnitX();
  return std::atan2(forward.y(), forward.x());
}

double wrap_angle(double angle) {
  const double wrapped = std::remainder(angle, 2.0 * std::numbers::pi);
  return wrapped <= -std::numbers::pi ? std::numbers::pi : wrapped;
}

Pose Pose::inverse() const {
  const Eigen::Quaterniond inverted = rotation.conjugate();
  return {inverted, -(inverted * translation)};
}

Pose Pose::operator*(const Pose& other) const {
  return {(rotation * other.rotation).normalized(), rotation * other.translation + translation};
}

Pose interpolate(const Pose& a, const Pose& b, double fraction) {
  return {a.rotation.slerp(fraction, b.rotation),
          a.translation + fraction * (b.translation - a.translation)};
}

}  // namespace aims
