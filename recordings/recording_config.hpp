// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <numbers>
#include <string>
#include <vector>

#include "core/config.hpp"
#include "core/leg_kinematics.hpp"

namespace aims {

/// Topics of a recording. An empty name: the default topic of AIMS, else the only topic of a
/// suitable type. "none": not used.
struct TopicsConfig {
  std::string lidar;         ///< sensor_msgs/PointCloud2 or livox_ros_driver(2)/CustomMsg
  std::string imu;           ///< sensor_msgs/Imu, or a robot's state (`robot_states`)
  std::string leg_odometry;  ///< nav_msgs/Odometry, geometry_msgs/TwistStamped or Twist,
                             ///< a robot's state with feet
  std::string joint_states;  ///< sensor_msgs/JointState or a robot's state, for legs without
                             ///< odometry
  std::string contacts;      ///< any message with an array of numbers, one per foot
  std::string truth;         ///< nav_msgs/Odometry or PoseStamped; read for scoring only
};

/// Whose pose the values of an extrinsic are.
enum class ExtrinsicDirection { kSensorInImu, kImuInSensor };

/// Extrinsics of a sensor, for a bag whose tf lacks them or is wrong; as a calibration states them.
struct ExtrinsicConfig {
  bool override_tf = false;  ///< use these values instead of the bag's tf
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();       ///< in the IMU frame [m]
  Eigen::Vector3d rotation_rpy_deg = Eigen::Vector3d::Zero();  ///< roll, pitch, yaw [deg]
  std::vector<double> rotation_matrix;  ///< 9 numbers, row by row, in place of the angles
  std::vector<double> quaternion_xyzw;  ///< 4 numbers, in place of the angles
  std::vector<double> quaternion_wxyz;  ///< the same, w first
  std::vector<double> matrix;           ///< 16 or 12 numbers, row by row, in place of all above
  ExtrinsicDirection direction = ExtrinsicDirection::kSensorInImu;
  std::string static_transform;  ///< arguments of a ROS static_transform_publisher
  std::string file;              ///< of a calibration; see recordings/frames/calibration_file.hpp
  std::vector<std::string> file_frames;  ///< the IMU's and the sensor's name there

  /// Whether numbers are stated; a translation and angles of zero need `override_tf`.
  bool has_numbers() const {
    return override_tf || !matrix.empty() || !rotation_matrix.empty() || !quaternion_xyzw.empty() ||
           !quaternion_wxyz.empty() || !translation.isZero(0.0) || !rotation_rpy_deg.isZero(0.0);
  }
  /// Whether tf is not asked.
  bool is_given() const { return has_numbers() || !static_transform.empty() || !file.empty(); }
};

enum class ImuUnit { kAuto, kMetres, kGravities, kMilligravities };

/// Unit of the angular velocity in a recording.
enum class GyroUnit { kRadians, kDegrees };
/// Unit of the angles of the joints; of their rates, per second.
enum class JointUnit { kRadians, kDegrees };
/// [rad]
constexpr double radians_per(JointUnit unit) {
  return unit == JointUnit::kDegrees ? std::numbers::pi / 180.0 : 1.0;
}
/// Unit of the points' coordinates.
enum class PointUnit { kMetres, kCentimetres, kMillimetres };
enum class PointTimeUnit { kAuto, kSeconds, kMilliseconds, kMicroseconds, kNanoseconds, kNone };
/// Instant of the scan that a cloud's header stamp marks.
enum class CloudStamp { kAuto, kStart, kEnd };

/// How a foot's load becomes a contact.
enum class ContactDetection {
  kAuto,       ///< learned for counts without calibration, else by the threshold
  kThreshold,  ///< by contact_threshold
  kLearned,    ///< two classes of loads, learned from the recording
};

/// How a recording is read.
struct RecordingConfig {
  TopicsConfig topics;
  std::string imu_frame;    ///< tf name; empty: the frame of the IMU's messages
  std::string lidar_frame;  ///< empty: the frame of the clouds
  std::string base_frame;   ///< of the legs; empty: child frame of the odometry
  ExtrinsicConfig T_imu_lidar;
  ExtrinsicConfig T_imu_base;
  ImuUnit imu_unit = ImuUnit::kAuto;
  GyroUnit gyro_unit = GyroUnit::kRadians;
  PointUnit point_unit = PointUnit::kMetres;
  PointTimeUnit point_time_unit = PointTimeUnit::kAuto;
  CloudStamp cloud_stamp = CloudStamp::kAuto;
  double lidar_rate = 10.0;     ///< scan rate, if no times of points are used [Hz]
  bool lidar_clockwise = true;  ///< direction of spin seen from above, likewise
  double imu_delay = 0.0;       ///< subtracted from the stamps of the IMU [s]
  double lidar_delay = 0.0;     ///< subtracted from the stamps of the LiDAR [s]
  double leg_delay = 0.0;       ///< subtracted from the stamps of the legs [s]
  std::string contacts_field;   ///< path of the array; empty: the first array of numbers
  ContactDetection contact_detection = ContactDetection::kAuto;
  double contact_threshold =
      20.0;  ///< smallest value of a foot in contact [N or the message's unit]
  std::vector<std::string> foot_names;   ///< of the array's entries, e.g. [FR, FL, RR, RL]
  std::vector<std::string> joint_names;  ///< of the 12 joints, leg by leg; empty: detected
  JointUnit joint_unit = JointUnit::kRadians;
  /// Of the robot. Lengths of 0 are those that a simulated recording states, else those of the
  /// robot of the message type, else of a Go1.
  LegGeometry leg_geometry;
  FootModel foot_model = FootModel::kPoint;  ///< for legs without odometry
  /// A record of a live estimate is read as that one read it.
  bool as_live = true;
};

void describe(Fields& fields, TopicsConfig& config);
void describe(Fields& fields, ExtrinsicConfig& config);
void describe(Fields& fields, RecordingConfig& config);

}  // namespace aims
