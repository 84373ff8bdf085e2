// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/recording_config.hpp"

namespace aims {
namespace {

Spec dimensionless(std::string meaning) { return {.unit = "-", .meaning = std::move(meaning)}; }

Spec delay_of(const std::string& sensor) {
  return {.unit = "s",
          .range = in_range(-4e9, 4e9),
          .meaning = "subtracted from the stamps of the " + sensor};
}

void describe_frames(Fields& f, RecordingConfig& c) {
  f.text("imu_frame", c.imu_frame,
         dimensionless("tf name; empty: the frame of the IMU's messages"));
  f.text("lidar_frame", c.lidar_frame, dimensionless("tf name; empty: the frame of the clouds"));
  f.text("base_frame", c.base_frame,
         dimensionless("tf name of the legs' base; empty: child frame of the odometry"));
  f.group("T_imu_lidar", c.T_imu_lidar);
  f.group("T_imu_base", c.T_imu_base);
}

void describe_clouds(Fields& f, RecordingConfig& c) {
  f.choice(
      "point_unit", c.point_unit,
      {{"m", PointUnit::kMetres}, {"cm", PointUnit::kCentimetres}, {"mm", PointUnit::kMillimetres}},
      dimensionless("unit of the points' coordinates"));
  f.choice("point_time_unit", c.point_time_unit,
           {{"auto", PointTimeUnit::kAuto},
            {"s", PointTimeUnit::kSeconds},
            {"ms", PointTimeUnit::kMilliseconds},
            {"us", PointTimeUnit::kMicroseconds},
            {"ns", PointTimeUnit::kNanoseconds},
            {"none", PointTimeUnit::kNone}},
           dimensionless("unit of the points' times; auto: from their span and the scan period; "
                         "none: azimuths serve in place of the times"));
  f.choice("cloud_stamp", c.cloud_stamp,
           {{"auto", CloudStamp::kAuto}, {"start", CloudStamp::kStart}, {"end", CloudStamp::kEnd}},
           dimensionless("end of the scan that a cloud's stamp marks; auto: from the points' times "
                         "and the arrival"));
  f.number("lidar_rate", c.lidar_rate,
           {.unit = "Hz",
            .range = in_range(1.0, 1000.0),
            .meaning = "scan rate, if neither stamps nor point times determine it"});
  f.flag("lidar_clockwise", c.lidar_clockwise,
         dimensionless("direction of spin seen from above, if no times of points are used"));
}

void describe_legs(Fields& f, RecordingConfig& c) {
  f.text("contacts_field", c.contacts_field,
         dimensionless("path of the array of contacts; empty: the first array of numbers"));
  f.choice("contact_detection", c.contact_detection,
           {{"auto", ContactDetection::kAuto},
            {"threshold", ContactDetection::kThreshold},
            {"learned", ContactDetection::kLearned}},
           dimensionless("contact from a load: above contact_threshold, or in the upper of two "
                         "classes learned from the recording; auto: learned for raw counts, "
                         "torques of robots' states and tables"));
  f.number("contact_threshold", c.contact_threshold,
           {.unit = "N",
            .range = up_to(1e6),
            .meaning = "smallest value of a foot in contact; of flags: 0.5"});
  f.texts(
      "foot_names", c.foot_names,
      dimensionless("names of the array's entries, e.g. [FR, FL, RR, RL]; empty: FL, FR, RL, RR"));
  f.texts("joint_names", c.joint_names,
          dimensionless("names of the 12 joints, or their indices where none are recorded: per leg "
                        "(FL, FR, RL, RR) abduction, hip, knee; empty: detected"));
  f.choice("joint_unit", c.joint_unit, {{"rad", JointUnit::kRadians}, {"deg", JointUnit::kDegrees}},
           dimensionless("unit of the joints' angles, and of their rates per second"));
  f.group("leg_geometry", c.leg_geometry);
  f.choice("foot_model", c.foot_model,
           {{"point", FootModel::kPoint}, {"rolling", FootModel::kRolling}},
           dimensionless("contact model of the foot, for legs without odometry"));
}

}  // namespace

void describe(Fields& f, TopicsConfig& c) {
  f.text("lidar", c.lidar, dimensionless("sensor_msgs/PointCloud2 or livox CustomMsg"));
  f.text("imu", c.imu, dimensionless("sensor_msgs/Imu, or a robot's state that has one"));
  f.text("leg_odometry", c.leg_odometry,
         dimensionless("nav_msgs/Odometry, geometry_msgs/TwistStamped or Twist, "
                       "or a robot's state with feet"));
  f.text("joint_states", c.joint_states,
         dimensionless("sensor_msgs/JointState, or a robot's state with joints"));
  f.text("contacts", c.contacts,
         dimensionless("any message with an array of numbers, one per foot"));
  f.text("truth", c.truth,
         dimensionless("nav_msgs/Odometry or geometry_msgs/PoseStamped, for scoring"));
}

void describe(Fields& f, ExtrinsicConfig& c) {
  f.flag("override_tf", c.override_tf,
         dimensionless("use these values instead of the bag's tf, also where all are 0"));
  f.vector("translation", c.translation,
           {.unit = "m", .range = in_range(-100.0, 100.0), .meaning = "in the IMU frame"});
  f.vector("rotation_rpy_deg", c.rotation_rpy_deg,
           {.unit = "deg",
            .range = in_range(-360.0, 360.0),
            .meaning = "roll, pitch, yaw: R = Rz(yaw) Ry(pitch) Rx(roll)"});
  const auto entries = [](std::string meaning) {
    return Spec{.unit = "m, -", .range = within(100.0), .meaning = std::move(meaning)};
  };
  f.numbers("rotation_matrix", c.rotation_matrix,
            entries("9 numbers, row by row, in place of the angles"));
  f.numbers("quaternion_xyzw", c.quaternion_xyzw, entries("4 numbers, in place of the angles"));
  f.numbers("quaternion_wxyz", c.quaternion_wxyz, entries("the same, w first"));
  f.numbers("matrix", c.matrix, entries("4x4 or 3x4, row by row, in place of all above"));
  f.choice("direction", c.direction,
           {{"sensor_in_imu", ExtrinsicDirection::kSensorInImu},
            {"imu_in_sensor", ExtrinsicDirection::kImuInSensor},
            {"lidar_in_imu", ExtrinsicDirection::kSensorInImu},
            {"imu_in_lidar", ExtrinsicDirection::kImuInSensor},
            {"base_in_imu", ExtrinsicDirection::kSensorInImu},
            {"imu_in_base", ExtrinsicDirection::kImuInSensor}},
           dimensionless("whose pose the values are, in whose frame"));
  f.text("static_transform", c.static_transform,
         dimensionless("arguments of a static_transform_publisher, of either ROS"));
  f.text("file", c.file,
         dimensionless("calibration: Kalibr, T_A_B in YAML, Ouster metadata, URDF, launch file"));
  f.texts("file_frames", c.file_frames,
          dimensionless("[IMU, sensor] as the file names them; empty: recognized"));
  f.idle_if(c.file.empty(), "file names no calibration", {"file_frames"});
  f.idle_if(!c.file.empty(), "the file names both frames", {"direction"});
  f.idle_if(!c.quaternion_xyzw.empty(), "quaternion_xyzw is given", {"rotation_rpy_deg"});
  f.idle_if(!c.quaternion_wxyz.empty(), "quaternion_wxyz is given",
            {"rotation_rpy_deg", "quaternion_xyzw"});
  f.idle_if(!c.rotation_matrix.empty(), "rotation_matrix is given",
            {"rotation_rpy_deg", "quaternion_xyzw", "quaternion_wxyz"});
  f.idle_if(
      !c.matrix.empty(), "matrix is given",
      {"translation", "rotation_rpy_deg", "rotation_matrix", "quaternion_xyzw", "quaternion_wxyz"});
}

void describe(Fields& f, RecordingConfig& c) {
  f.group("topics", c.topics);
  describe_frames(f, c);
  f.choice("imu_unit", c.imu_unit,
           {{"auto", ImuUnit::kAuto},
            {"m/s^2", ImuUnit::kMetres},
            {"g", ImuUnit::kGravities},
            {"mg", ImuUnit::kMilligravities}},
           dimensionless("unit of the specific force; auto: from its norm at the start"));
  f.choice("gyro_unit", c.gyro_unit, {{"rad/s", GyroUnit::kRadians}, {"deg/s", GyroUnit::kDegrees}},
           dimensionless("unit of the angular velocity"));
  describe_clouds(f, c);
  f.number("imu_delay", c.imu_delay, delay_of("IMU"));
  f.number("lidar_delay", c.lidar_delay, delay_of("LiDAR"));
  f.number("leg_delay", c.leg_delay, delay_of("legs"));
  describe_legs(f, c);
  f.flag("as_live", c.as_live,
         dimensionless("read the record of a live estimate as that one did: units, clocks and "
                       "contacts from what it had heard when it started"));
}

}  // namespace aims
