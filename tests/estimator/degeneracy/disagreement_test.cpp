// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/degeneracy/disagreement.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace aims {
namespace {

/// A walk along x at which legs and scans may each report another speed; scans every 0.1 s.
struct Walk {
  double lidar_speed = 0.7;
  double leg_speed = 0.7;
  bool firm = true;
  double sees_axis = 1.0;
};

class Walker {
 public:
  explicit Walker(const DisagreementConfig& config) : judge_(config) {}

  void go(const Walk& walk, double duration, bool legs = true) {
    const int scans = static_cast<int>(std::lround(duration / 0.1));
    for (int i = 0; i < scans; ++i) {
      for (int k = 0; k < 20; ++k) {
        time_ += from_seconds(0.005);
        LegMotionTold told;
        told.stamp = time_;
        told.velocity.x() = walk.leg_speed;
        told.noise = Eigen::Matrix3d::Identity() * 1e-5;
        told.firm = walk.firm;
        if (legs) judge_.add(told);
      }
      x_ += 0.1 * walk.lidar_speed;
      LidarFix fix;
      fix.stamp = time_;
      fix.position.x() = x_;
      fix.covariance = Eigen::Matrix3d::Identity() * 1e-6;
      fix.axes = axes;
      fix.trusted = Eigen::Vector3d(walk.sees_axis, 1.0, 1.0);
      judge_.judge(fix, leg_drift);
    }
  }

  const Disagreement& judge() const { return judge_; }

  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d leg_drift = Eigen::Matrix3d::Zero();

 private:
  Disagreement judge_;
  Time time_ = kSecond;
  double x_ = 0.0;
};

TEST(Disagreement, AgreementCostsNothing) {
  Walker walker({});
  walker.go({}, 5.0);
  EXPECT_EQ(walker.judge().lidar_share(), Eigen::Vector3d::Ones());
  EXPECT_EQ(walker.judge().leg_growth(), 1.0);
}

TEST(Disagreement, AScanThatStaysBehindLosesWeightAlongThatAxisAlone) {
  Walker walker({});
  walker.go({.lidar_speed = 0.0}, 3.0);
  const Eigen::Vector3d share = walker.judge().lidar_share();
  // 0.7 s at 0.7 m/s against 3 sigma of sqrt(2 (0.01^2 + 1e-6) + 0.7e-5): the excess squared.
  const double excess = 0.49 / (3.0 * std::sqrt(2.0 * (1e-4 + 1e-6) + 0.7e-5));
  EXPECT_NEAR(share.x(), 1.0 / std::min(excess * excess, 100.0), 1e-3);
  EXPECT_EQ(share.tail<2>(), Eigen::Vector2d::Ones());
  EXPECT_EQ(walker.judge().leg_growth(), 1.0);
}

TEST(Disagreement, LegsThatContradictThemselvesLoseTheWeightInstead) {
  Walker walker({});
  walker.go({.lidar_speed = 0.4, .firm = false}, 3.0);
  EXPECT_EQ(walker.judge().lidar_share(), Eigen::Vector3d::Ones());
  EXPECT_GT(walker.judge().leg_growth(), 4.0);
}

TEST(Disagreement, AShortOneIsForgiven) {
  Walker walker({});
  walker.go({}, 3.0);
  walker.go({.lidar_speed = 0.0}, 0.3);
  EXPECT_EQ(walker.judge().lidar_share(), Eigen::Vector3d::Ones());
  walker.go({}, 2.0);
  EXPECT_EQ(walker.judge().lidar_share(), Eigen::Vector3d::Ones());
}

TEST(Disagreement, EndsWhenBothAgreeAgain) {
  Walker walker({});
  walker.go({.lidar_speed = 0.0}, 3.0);
  ASSERT_LT(walker.judge().lidar_share().x(), 0.1);
  walker.go({}, 1.0);
  EXPECT_EQ(walker.judge().lidar_share(), Eigen::Vector3d::Ones());
}

TEST(Disagreement, MissingLegsDoNotResetIt) {
  Walker walker({});
  walker.go({.lidar_speed = 0.0}, 3.0);
  const double share = walker.judge().lidar_share().x();
  walker.go({.lidar_speed = 0.7}, 1.0, false);
  EXPECT_EQ(walker.judge().lidar_share().x(), share);
}

TEST(Disagreement, AnAxisThatTheScanDoesNotSeeIsNotJudged) {
  Walker walker({});
  walker.go({.lidar_speed = 0.0, .sees_axis = 0.1}, 3.0);
  EXPECT_EQ(walker.judge().lidar_share(), Eigen::Vector3d::Ones());
  EXPECT_EQ(walker.judge().leg_growth(), 1.0);
}

TEST(Disagreement, LegsOfUnknownScaleAccuseNobody) {
  Walker walker({});
  walker.leg_drift.diagonal().setConstant(0.14 * 0.14);  // 20 % of 0.7 m/s
  walker.go({.lidar_speed = 0.45}, 3.0);
  EXPECT_EQ(walker.judge().lidar_share(), Eigen::Vector3d::Ones());
}

TEST(Disagreement, GoesWithItsDirectionWhenAxesSwap) {
  Walker walker({});
  walker.go({.lidar_speed = 0.0}, 3.0);
  walker.axes.col(0) = Eigen::Vector3d::UnitY();
  walker.axes.col(1) = Eigen::Vector3d::UnitX();
  walker.go({.lidar_speed = 0.0}, 0.1);
  EXPECT_EQ(walker.judge().lidar_share().x(), 1.0);
  EXPECT_LT(walker.judge().lidar_share().y(), 0.1);
}

}  // namespace
}  // namespace aims
