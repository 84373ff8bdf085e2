// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/interface/motion.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "estimator/registry.hpp"
#include "tests/support/kinematic_world.hpp"

namespace aims {
namespace {

constexpr Time kNewest = std::numeric_limits<Time>::max();

/// A walk, estimated delivery by delivery.
class Motion : public testing::Test {
 protected:
  Motion()
      : world_(test::short_walk()),
        deliveries_(test::record(world_)),
        estimator_(std::move(*make_estimator("aims_d", world_.rig()))),
        source_(dynamic_cast<const MotionSource*>(estimator_.get())) {}

  /// In the world's axes [m/s].
  Eigen::Vector3d true_velocity(Time stamp) const {
    constexpr Duration kStep = kMillisecond;
    return (world_.T_world_body(stamp + kStep).translation -
            world_.T_world_body(stamp - kStep).translation) /
           to_seconds(2 * kStep);
  }

  const Trajectory& trajectory() const { return estimator_->result().trajectory; }

  test::KinematicWorld world_;
  std::vector<Delivery> deliveries_;
  std::unique_ptr<Estimator> estimator_;
  const MotionSource* source_;
};

TEST_F(Motion, IsThePoseOfTheTrajectoryAtItsStamp) {
  ASSERT_NE(source_, nullptr);
  EXPECT_FALSE(source_->motion(kNewest)) << "not started";
  std::size_t seen = 0;
  for (const Delivery& delivery : deliveries_) {
    estimator_->consume(delivery);
    if (trajectory().size() == seen) continue;
    seen = trajectory().size();
    const StampedPose& pose = trajectory().back();
    const auto motion = source_->motion(pose.stamp);
    ASSERT_TRUE(motion);
    // A packet of the legs may have been fused since.
    EXPECT_LE(motion->stamp - pose.stamp, 10 * kMillisecond);
    EXPECT_LT((motion->T_odom_body.translation - pose.pose.translation).norm(), 0.02);
  }
  EXPECT_GT(seen, 100U);
}

TEST_F(Motion, PredictsBetweenScansWhatTheTruthIsAndHowWell) {
  double sum_position = 0.0;
  double sum_velocity = 0.0;
  double normalized = 0.0;
  int count = 0;
  Time last = 0;
  for (const Delivery& delivery : deliveries_) {
    estimator_->consume(delivery);
    if (!std::holds_alternative<ImuSample>(delivery.measurement) || trajectory().empty()) continue;
    const auto motion = source_->motion(kNewest);
    ASSERT_TRUE(motion);
    EXPECT_GE(motion->stamp, last);
    EXPECT_LE(delivery.arrival - motion->stamp, 50 * kMillisecond) << "as new as the IMU is";
    last = motion->stamp;
    const Pose T_world_odom = test::T_world_odom(trajectory(), world_);
    const Pose estimated = T_world_odom * motion->T_odom_body;
    const Eigen::Vector3d velocity = T_world_odom.rotation * motion->velocity;
    const Eigen::Vector3d error = velocity - true_velocity(motion->stamp);
    sum_position +=
        (estimated.translation - world_.T_world_body(motion->stamp).translation).squaredNorm();
    sum_velocity += error.squaredNorm();
    const Eigen::Vector3d in_odom = T_world_odom.rotation.conjugate() * error;
    normalized += in_odom.dot(motion->covariance.bottomRightCorner<3, 3>().inverse() * in_odom);
    ++count;
  }
  ASSERT_GT(count, 500);
  const double position = std::sqrt(sum_position / count);
  const double velocity = std::sqrt(sum_velocity / count);
  std::cout << count << " predictions: RMS " << position << " m, " << velocity
            << " m/s; normalized squared error of the velocity " << normalized / count
            << ", expected 3\n";
  EXPECT_LT(position, 0.05);
  EXPECT_LT(velocity, 0.1);
  EXPECT_GT(normalized / count, 0.3);
  EXPECT_LT(normalized / count, 12.0);
}

}  // namespace
}  // namespace aims
