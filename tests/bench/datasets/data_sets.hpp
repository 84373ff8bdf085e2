// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/cloud_layout.hpp"
#include "core/lie.hpp"
#include "core/measurements.hpp"
#include "core/trajectory.hpp"

namespace aims::test {

/// Measurements of a walk and its truth, before any format.
struct Walked {
  std::vector<Delivery> deliveries;
  Pose T_imu_lidar;
  Trajectory truth;  ///< of the IMU
};

/// A walk of `length` metres out and back between walls with doors, of tests/independent.
Walked walk_of(const std::filesystem::path& folder, double length);

/// How a data set writes its recordings, from its documents and the definitions of its messages.
struct DataSet {
  std::string lidar_topic, lidar_frame;
  std::string imu_topic, imu_frame;
  CloudLayout layout = CloudLayout::kVelodyne;
  bool custom_message = false;      ///< livox_ros_driver2/CustomMsg
  bool stamped_at_end = false;      ///< clouds
  Pose T_imu_lidar = {};            ///< by its documents
  bool has_tf = false;              ///< which states it
  bool bag_per_topic = false;       ///< a folder of them per sequence
  std::string prism_topic = {};     ///< geometry_msgs/PointStamped
  std::string odometry_topic = {};  ///< nav_msgs/Odometry of the legs
  bool high_state = false;          ///< unitree_legged_msgs/HighState at 500 Hz, new every 20 ms
};

/// Writes the walk as the sequence `name` of the data set into the folder.
void write_sequence(const Walked& walked, const DataSet& data, const std::string& name,
                    const Eigen::Vector3d& p_imu_prism, const std::filesystem::path& folder);

/// Writes packets of an Ouster that stands in a room, with its metadata, as the old ouster_ros did:
/// /os_cloud_node/lidar_packets, imu_packets (ouster_ros/PacketMsg), metadata. Its clock is that of
/// the recording.
void write_ouster_packets(const std::filesystem::path& file, int turns);

/// Stamps of the recordings are those of the walk after this.
inline constexpr Time kDataEpoch = 1'700'000'000 * kSecond;

}  // namespace aims::test
