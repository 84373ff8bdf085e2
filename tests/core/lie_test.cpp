// SPDX-License-Identifier: BSD-3-Clause
#include "core/lie.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
// rapidcheck's gtest glue needs both headers above it.
#include <rapidcheck/gtest.h>

#include <cmath>
#include <numbers>

namespace aims {
namespace {

constexpr double kPi = std::numbers::pi;

/// Angles [rad] around every border of the implementation: zero, the series' end, pi.
const std::vector<double> kAngles = {0.0,  1e-300,     1e-12,      1e-8,       0.99e-4,
                                     1e-4, 1.01e-4,    1e-3,       0.5,        1.5,
                                     3.0,  kPi - 1e-4, kPi - 1e-8, kPi - 1e-12};

const std::vector<Eigen::Vector3d> kAxes = {Eigen::Vector3d::UnitX(), -Eigen::Vector3d::UnitZ(),
                                            Eigen::Vector3d(1.0, -2.0, 0.5).normalized()};

/// A vector of numbers in [-bound, bound].
Eigen::Vector3d random_vector(double bound) {
  const auto number = rc::gen::map(rc::gen::inRange(-1'000'000, 1'000'001),
                                   [bound](int each) { return 1e-6 * bound * each; });
  const double x = *number;
  const double y = *number;
  const double z = *number;
  return {x, y, z};
}

/// Rotation matrix by the power series of the matrix exponential.
Eigen::Matrix3d exp_by_series(const Eigen::Vector3d& phi) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d term = sum;
  for (int k = 1; k < 40; ++k) {
    term = term * hat(phi) / k;
    sum += term;
  }
  return sum;
}

RC_GTEST_PROP(Hat, IsTheCrossProduct, ()) {
  const Eigen::Vector3d a = random_vector(10.0);
  const Eigen::Vector3d b = random_vector(10.0);
  RC_ASSERT((hat(a) * b - a.cross(b)).norm() < 1e-12);
  RC_ASSERT(hat(a) == -hat(a).transpose());
}

TEST(So3, ExpIsTheMatrixExponential) {
  for (const double angle : kAngles) {
    for (const Eigen::Vector3d& axis : kAxes) {
      const Eigen::Matrix3d R = so3_exp(angle * axis).toRotationMatrix();
      EXPECT_LT((R - exp_by_series(angle * axis)).norm(), 1e-13) << angle;
    }
  }
}

TEST(So3, LogUndoesExpUpToPi) {
  for (const double angle : kAngles) {
    for (const Eigen::Vector3d& axis : kAxes) {
      const Eigen::Vector3d phi = angle * axis;
      EXPECT_LT((so3_log(so3_exp(phi)) - phi).norm(), 1e-14 * (1.0 + angle) + 1e-10 * angle)
          << angle;
    }
  }
}

TEST(So3, LogKeepsTheRelativePrecisionOfTinyRotations) {
  for (const double angle : {1e-12, 1e-9, 1e-6, 0.99e-4, 1.01e-4}) {
    EXPECT_NEAR(so3_log(so3_exp({0.0, angle, 0.0})).y() / angle, 1.0, 1e-12) << angle;
  }
}

TEST(So3, LogOfHalfATurnHasNormPi) {
  for (const Eigen::Vector3d& axis : kAxes) {
    EXPECT_NEAR(so3_log(so3_exp(kPi * axis)).norm(), kPi, 1e-12);
  }
}

RC_GTEST_PROP(So3, LogIsTheSameForBothSignsOfTheQuaternion, ()) {
  const Eigen::Quaterniond q = so3_exp(random_vector(1.8));
  const Eigen::Quaterniond minus_q(-q.w(), -q.x(), -q.y(), -q.z());
  RC_ASSERT((so3_log(q) - so3_log(minus_q)).norm() < 1e-12);
  RC_ASSERT(so3_log(q).norm() <= kPi + 1e-12);
}

TEST(So3, RightJacobianMatchesFiniteDifferences) {
  constexpr double kDelta = 1e-6;
  for (const double angle : kAngles) {
    for (const Eigen::Vector3d& axis : kAxes) {
      const Eigen::Vector3d phi = angle * axis;
      Eigen::Matrix3d numeric;
      for (int i = 0; i < 3; ++i) {
        const Eigen::Vector3d d = kDelta * Eigen::Vector3d::Unit(i);
        const Eigen::Quaterniond base = so3_exp(phi).conjugate();
        numeric.col(i) =
            (so3_log(base * so3_exp(phi + d)) - so3_log(base * so3_exp(phi - d))) / (2.0 * kDelta);
      }
      EXPECT_LT((numeric - so3_right_jacobian(phi)).norm(), 1e-8) << angle;
    }
  }
}

TEST(So3, InverseOfTheRightJacobianIsItsInverse) {
  for (const double angle : kAngles) {
    for (const Eigen::Vector3d& axis : kAxes) {
      const Eigen::Vector3d phi = angle * axis;
      const Eigen::Matrix3d product = so3_right_jacobian(phi) * so3_right_jacobian_inverse(phi);
      EXPECT_LT((product - Eigen::Matrix3d::Identity()).norm(), 1e-8) << angle;
    }
  }
}

RC_GTEST_PROP(PoseComposition, IsAssociativeAndInverted, ()) {
  const auto pose = [] { return Pose{so3_exp(random_vector(3.0)), random_vector(50.0)}; };
  const Pose a = pose();
  const Pose b = pose();
  const Eigen::Vector3d p = random_vector(50.0);
  RC_ASSERT((((a * b) * p) - (a * (b * p))).norm() < 1e-10);
  RC_ASSERT(((a.inverse() * (a * p)) - p).norm() < 1e-10);
  RC_ASSERT(((a * p) - (a.R() * p + a.translation)).norm() < 1e-10);
  RC_ASSERT(std::abs((a * b).rotation.norm() - 1.0) < 1e-14);
}

TEST(Yaw, OfARotationAboutZIsItsAngle) {
  for (const double yaw : {-3.0, -1.0, 0.0, 0.5, 3.1, kPi}) {
    EXPECT_NEAR(yaw_of(yaw_rotation(yaw)), yaw, 1e-14);
  }
}

TEST(Yaw, IsTheHeadingOfTheForwardAxisUnderTilt) {
  const Eigen::Quaterniond tilted =
      yaw_rotation(1.2) * so3_exp({0.0, 0.4, 0.0}) * so3_exp({0.3, 0.0, 0.0});
  EXPECT_NEAR(yaw_of(tilted), 1.2, 1e-14);
}

RC_GTEST_PROP(WrapAngle, StaysInItsIntervalAndOnTheCircle, (int thousandths)) {
  const double angle = 1e-3 * (thousandths % 100'000);
  const double wrapped = wrap_angle(angle);
  RC_ASSERT(wrapped > -kPi);
  RC_ASSERT(wrapped <= kPi);
  RC_ASSERT(std::abs(std::sin(wrapped) - std::sin(angle)) < 1e-12);
  RC_ASSERT(std::abs(std::cos(wrapped) - std::cos(angle)) < 1e-12);
}

TEST(WrapAngle, HalfATurnIsPlusPi) {
  EXPECT_EQ(wrap_angle(kPi), kPi);
  EXPECT_EQ(wrap_angle(-kPi), kPi);
}

TEST(Interpolate, MeetsBothEndsAtConstantAngularRate) {
  const Pose a = {yaw_rotation(0.2), {0.0, 0.0, 0.0}};
  const Pose b = {yaw_rotation(1.2), {4.0, -2.0, 1.0}};
  EXPECT_EQ(interpolate(a, b, 0.0).translation, a.translation);
  EXPECT_EQ(interpolate(a, b, 1.0).translation, b.translation);
  const Pose quarter = interpolate(a, b, 0.25);
  EXPECT_LT((quarter.translation - Eigen::Vector3d(1.0, -0.5, 0.25)).norm(), 1e-15);
  EXPECT_NEAR(yaw_of(quarter.rotation), 0.45, 1e-14);
}

TEST(Interpolate, TakesTheShorterRotation) {
  Pose b = {yaw_rotation(0.4), Eigen::Vector3d::Zero()};
  b.rotation.coeffs() *= -1.0;
  EXPECT_NEAR(yaw_of(interpolate(Pose(), b, 0.5).rotation), 0.2, 1e-14);
}

}  // namespace
}  // namespace aims
