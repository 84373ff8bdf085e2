// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/messages/message_types.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "recordings/messages/message_definition.hpp"
#include "recordings/messages/ros2_definition.hpp"

namespace aims {
namespace {

/// A type, its fields as ROS 1 writes them, and the md5 of those that AIMS writes.
struct KnownType {
  std::string_view name;
  std::string_view fields;
  std::string_view md5 = "";
};

constexpr std::string_view kLivoxMessage =
    "Header header\nuint64 timebase\nuint32 point_num\nuint8 lidar_id\nuint8[3] rsvd\n"
    "CustomPoint[] points\n";
constexpr std::string_view kLivoxPoint =
    "uint32 offset_time\nfloat32 x\nfloat32 y\nfloat32 z\nuint8 reflectivity\nuint8 tag\n"
    "uint8 line\n";

constexpr auto kTypes = std::to_array<KnownType>({
    {"std_msgs/Header", "uint32 seq\ntime stamp\nstring frame_id\n"},
    {"std_msgs/String", "string data\n", "992ce8a1687cec8c8bd883ec73ca41d1"},
    {"geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z\n"},
    {"geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z\n"},
    {"geometry_msgs/Quaternion", "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n"},
    {"geometry_msgs/Pose", "Point position\nQuaternion orientation\n"},
    {"geometry_msgs/PoseStamped", "Header header\nPose pose\n"},
    {"geometry_msgs/PoseWithCovariance", "Pose pose\nfloat64[36] covariance\n"},
    {"geometry_msgs/PoseWithCovarianceStamped", "Header header\nPoseWithCovariance pose\n"},
    {"geometry_msgs/Twist", "Vector3 linear\nVector3 angular\n"},
    {"geometry_msgs/TwistStamped", "Header header\nTwist twist\n"},
    {"geometry_msgs/TwistWithCovariance", "Twist twist\nfloat64[36] covariance\n"},
    {"geometry_msgs/TwistWithCovarianceStamped", "Header header\nTwistWithCovariance twist\n"},
    {"geometry_msgs/Transform", "Vector3 translation\nQuaternion rotation\n"},
    {"geometry_msgs/TransformStamped",
     "Header header\nstring child_frame_id\nTransform transform\n"},
    {"nav_msgs/Path", "Header header\ngeometry_msgs/PoseStamped[] poses\n"},
    {"nav_msgs/Odometry",
     "Header header\nstring child_frame_id\n"
     "geometry_msgs/PoseWithCovariance pose\n"
     "geometry_msgs/TwistWithCovariance twist\n",
     "cd5e73d190d741a2f92e81eda573aca7"},
    {"diagnostic_msgs/KeyValue", "string key\nstring value\n"},
    {"diagnostic_msgs/DiagnosticStatus",
     "byte OK=0\nbyte WARN=1\nbyte ERROR=2\nbyte STALE=3\nbyte level\nstring name\n"
     "string message\nstring hardware_id\nKeyValue[] values\n"},
    {"diagnostic_msgs/DiagnosticArray", "Header header\nDiagnosticStatus[] status\n",
     "60810da900de1dd6ddd437c3503511da"},
    {"sensor_msgs/PointField",
     "uint8 INT8=1\nuint8 UINT8=2\nuint8 INT16=3\nuint8 UINT16=4\nuint8 INT32=5\nuint8 UINT32=6\n"
     "uint8 FLOAT32=7\nuint8 FLOAT64=8\nstring name\nuint32 offset\nuint8 datatype\nuint32 "
     "count\n"},
    {"sensor_msgs/PointCloud2",
     "Header header\nuint32 height\nuint32 width\nPointField[] fields\n"
     "bool is_bigendian\nuint32 point_step\nuint32 row_step\nuint8[] data\n"
     "bool is_dense\n",
     "1158d486dd51d683ce2f1be655c3c181"},
    {"sensor_msgs/Imu",
     "Header header\ngeometry_msgs/Quaternion orientation\n"
     "float64[9] orientation_covariance\n"
     "geometry_msgs/Vector3 angular_velocity\n"
     "float64[9] angular_velocity_covariance\n"
     "geometry_msgs/Vector3 linear_acceleration\n"
     "float64[9] linear_acceleration_covariance\n",
     "6a62c6daae103f4ff57a132d6f95cec2"},
    {"sensor_msgs/JointState",
     "Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\n"
     "float64[] effort\n",
     "3066dcd76a6cfaef579bd0f34173e9fd"},
    {"tf2_msgs/TFMessage", "geometry_msgs/TransformStamped[] transforms\n",
     "94810edda583a504dfda3829e70d7eec"},
    {"aims_msgs/FootContacts", "Header header\nstring[] foot\nbool[] contact\nfloat64[] force\n",
     "8b09c12c9b63045360d7dd28104f0e10"},
    {kFootLoads, "Header header\nstring[] name\nfloat64[] load\n"},
    {kFootPlaces, "Header header\ngeometry_msgs/Point[] place\n"},
    {kFootForces, "Header header\nstring[] foot\nfloat64[] force\n",
     "0e9adc5ef17fe874de1d5f3df81ec97a"},
    {kUnitreeLowState,
     "uint8[2] head\nuint8 level_flag\nuint8 frame_reserve\nuint32[2] sn\nuint32[2] version\n"
     "uint16 bandwidth\nIMUState imu_state\nMotorState[20] motor_state\nBmsState bms_state\n"
     "int16[4] foot_force\nint16[4] foot_force_est\nuint32 tick\nuint8[40] wireless_remote\n"
     "uint8 bit_flag\nfloat32 adc_reel\nint8 temperature_ntc1\nint8 temperature_ntc2\n"
     "float32 power_v\nfloat32 power_a\nuint16[4] fan_frequency\nuint32 reserve\nuint32 crc\n"},
    {kUnitreeSportState,
     "TimeSpec stamp\nuint32 error_code\nIMUState imu_state\nuint8 mode\nfloat32 progress\n"
     "uint8 gait_type\nfloat32 foot_raise_height\nfloat32[3] position\nfloat32 body_height\n"
     "float32[3] velocity\nfloat32 yaw_speed\nfloat32[4] range_obstacle\nint16[4] foot_force\n"
     "float32[12] foot_position_body\nfloat32[12] foot_speed_body\n"},
    {"unitree_go/IMUState",
     "float32[4] quaternion\nfloat32[3] gyroscope\nfloat32[3] accelerometer\nfloat32[3] rpy\n"
     "int8 temperature\n"},
    {"unitree_go/MotorState",
     "uint8 mode\nfloat32 q\nfloat32 dq\nfloat32 ddq\nfloat32 tau_est\nfloat32 q_raw\n"
     "float32 dq_raw\nfloat32 ddq_raw\nint8 temperature\nuint32 lost\nuint32[2] reserve\n"},
    {"unitree_go/BmsState",
     "uint8 version_high\nuint8 version_low\nuint8 status\nuint8 soc\nint32 current\n"
     "uint16 cycle\nint8[2] bq_ntc\nint8[2] mcu_ntc\nuint16[15] cell_vol\n"},
    {"unitree_go/TimeSpec", "int32 sec\nuint32 nanosec\n"},
    {"unitree_hg/LowState",
     "uint32[2] version\nuint8 mode_pr\nuint8 mode_machine\nuint32 tick\nIMUState imu_state\n"
     "MotorState[35] motor_state\nuint8[40] wireless_remote\nuint32[4] reserve\nuint32 crc\n"},
    {"unitree_hg/IMUState",
     "float32[4] quaternion\nfloat32[3] gyroscope\nfloat32[3] accelerometer\nfloat32[3] rpy\n"
     "int16 temperature\n"},
    {"unitree_hg/MotorState",
     "uint8 mode\nfloat32 q\nfloat32 dq\nfloat32 ddq\nfloat32 tau_est\nint16[2] temperature\n"
     "float32 vol\nuint32[2] sensor\nuint32 motorstate\nuint32[4] reserve\n"},
    {"spot_msgs/FootStateArray", "Header header\nFootState[] states\n"},
    {"spot_msgs/FootState",
     "geometry_msgs/Point foot_position_rt_body\nuint8 contact\nTerrainState terrain\n"},
    {"spot_msgs/TerrainState",
     "float32 ground_mu_est\nstring frame_name\n"
     "geometry_msgs/Vector3 foot_slip_distance_rt_frame\n"
     "geometry_msgs/Vector3 foot_slip_velocity_rt_frame\n"
     "geometry_msgs/Vector3 ground_contact_normal_rt_frame\n"
     "float32 visual_surface_ground_penetration_mean\n"
     "float32 visual_surface_ground_penetration_std\n"},
    {"livox_ros_driver/CustomMsg", kLivoxMessage},
    {"livox_ros_driver/CustomPoint", kLivoxPoint},
    {"livox_ros_driver2/CustomMsg", kLivoxMessage},
    {"livox_ros_driver2/CustomPoint", kLivoxPoint},
});

const KnownType* find_known(std::string_view name) {
  const auto found = std::ranges::find(kTypes, name, &KnownType::name);
  return found == kTypes.end() ? nullptr : &*found;
}

/// The types that `user` uses, each in front of those that it uses itself.
void add_used(const KnownType& user, std::vector<const KnownType*>& used) {
  const std::string name(user.name);
  const auto parsed = parse_definition(name, user.fields);
  if (!parsed) return;
  const std::string package = name.substr(0, name.find('/') + 1);
  for (const FieldDefinition& field : parsed->front().fields) {
    const KnownType* type = find_known(field.type == "Header" ? kHeaderType : field.type);
    if (type == nullptr) type = find_known(package + field.type);
    if (type == nullptr || std::ranges::find(used, type) != used.end()) continue;
    used.push_back(type);
    add_used(*type, used);
  }
}

MessageType type_of(const KnownType& known) {
  std::string definition(known.fields);
  std::vector<const KnownType*> used;
  add_used(known, used);
  for (const KnownType* each : used) {
    definition += "\n" + std::string(80, '=') + "\nMSG: ";
    definition += each->name;
    definition += "\n";
    definition += each->fields;
  }
  return {std::string(known.name), std::string(known.md5), std::move(definition)};
}

}  // namespace

MessageType string_type() { return type_of(*find_known("std_msgs/String")); }
MessageType point_cloud_type() { return type_of(*find_known("sensor_msgs/PointCloud2")); }
MessageType imu_type() { return type_of(*find_known("sensor_msgs/Imu")); }
MessageType joint_state_type() { return type_of(*find_known("sensor_msgs/JointState")); }
MessageType odometry_type() { return type_of(*find_known("nav_msgs/Odometry")); }
MessageType transforms_type() { return type_of(*find_known("tf2_msgs/TFMessage")); }
MessageType diagnostics_type() { return type_of(*find_known("diagnostic_msgs/DiagnosticArray")); }
MessageType foot_forces_type() { return type_of(*find_known(kFootForces)); }
MessageType foot_loads_type() { return type_of(*find_known(kFootLoads)); }
MessageType foot_places_type() { return type_of(*find_known(kFootPlaces)); }
MessageType foot_contacts_type() { return type_of(*find_known("aims_msgs/FootContacts")); }

std::optional<MessageType> known_ros2_type(std::string_view name) {
  const KnownType* known = find_known(name);
  if (known == nullptr) return std::nullopt;
  auto type = ros2_type(type_of(*known));
  return type ? std::optional(std::move(*type)) : std::nullopt;
}

void complete_definition(std::string_view type, std::string& definition, MessageFormat& format) {
  if (!definition.empty() || format.serialization != Serialization::kCdr) return;
  auto known = known_ros2_type(type);
  if (!known) return;
  definition = std::move(known->definition);
  format = known->format;
}

}  // namespace aims
