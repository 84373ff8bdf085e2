// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

namespace aims {

// Topics and frames of the recordings that AIMS writes.
inline constexpr std::string_view kLidarTopic = "/lidar/points";
inline constexpr std::string_view kImuTopic = "/imu/data";
inline constexpr std::string_view kFastImuTopic = "/imu/data_fast";
inline constexpr std::string_view kLegOdometryTopic = "/leg_odometry";
inline constexpr std::string_view kJointStatesTopic = "/joint_states";
inline constexpr std::string_view kFootContactsTopic = "/foot_contacts";
inline constexpr std::string_view kTruthImuTopic = "/ground_truth/imu";
inline constexpr std::string_view kTruthLidarTopic = "/ground_truth/lidar";
inline constexpr std::string_view kStaticTransformsTopic = "/tf_static";
inline constexpr std::string_view kScenarioTopic = "/aims/scenario";
inline constexpr std::string_view kWaypointTimesTopic = "/aims/waypoint_times";

inline constexpr std::string_view kImuFrame = "imu";
inline constexpr std::string_view kLidarFrame = "lidar";
inline constexpr std::string_view kBaseFrame = "base";
inline constexpr std::string_view kOdometryFrame = "odom";
inline constexpr std::string_view kWorldFrame = "world";

}  // namespace aims
