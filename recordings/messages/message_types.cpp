// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/messages/message_types.hpp"

#include <initializer_list>
#include <string_view>

namespace aims {
namespace {

/// A type that other types contain.
struct Part {
  std::string_view name;
  std::string_view fields;
};

constexpr Part kHeader = {"std_msgs/Header", "uint32 seq\ntime stamp\nstring frame_id\n"};
constexpr Part kVector3 = {"geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z\n"};
constexpr Part kPoint = {"geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z\n"};
constexpr Part kQuaternion = {"geometry_msgs/Quaternion",
                              "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n"};
constexpr Part kPose = {"geometry_msgs/Pose", "Point position\nQuaternion orientation\n"};
constexpr Part kTwist = {"geometry_msgs/Twist", "Vector3 linear\nVector3 angular\n"};
constexpr Part kPoseWithCovariance = {"geometry_msgs/PoseWithCovariance",
                                      "Pose pose\nfloat64[36] covariance\n"};
constexpr Part kTwistWithCovariance = {"geometry_msgs/TwistWithCovariance",
                                       "Twist twist\nfloat64[36] covariance\n"};
constexpr Part kTransform = {"geometry_msgs/Transform",
                             "Vector3 translation\nQuaternion rotation\n"};
constexpr Part kTransformStamped = {"geometry_msgs/TransformStamped",
                                    "Header header\nstring child_frame_id\nTransform transform\n"};
constexpr Part kPointField = {
    "sensor_msgs/PointField",
    "uint8 INT8=1\nuint8 UINT8=2\nuint8 INT16=3\nuint8 UINT16=4\nuint8 INT32=5\nuint8 UINT32=6\n"
    "uint8 FLOAT32=7\nuint8 FLOAT64=8\nstring name\nuint32 offset\nuint8 datatype\nuint32 count\n"};

std::string definition(std::string_view fields, std::initializer_list<Part> parts) {
  std::string text(fields);
  for (const Part& part : parts) {
    text += "\n" + std::string(80, '=') + "\nMSG: ";
    text += part.name;
    text += "\n";
    text += part.fields;
  }
  return text;
}

}  // namespace

MessageType string_type() {
  return {"std_msgs/String", "992ce8a1687cec8c8bd883ec73ca41d1", definition("string data\n", {})};
}

MessageType point_cloud_type() {
  return {"sensor_msgs/PointCloud2", "1158d486dd51d683ce2f1be655c3c181",
          definition("Header header\nuint32 height\nuint32 width\nPointField[] fields\n"
                     "bool is_bigendian\nuint32 point_step\nuint32 row_step\nuint8[] data\n"
                     "bool is_dense\n",
                     {kHeader, kPointField})};
}

MessageType imu_type() {
  return {"sensor_msgs/Imu", "6a62c6daae103f4ff57a132d6f95cec2",
          definition("Header header\ngeometry_msgs/Quaternion orientation\n"
                     "float64[9] orientation_covariance\n"
                     "geometry_msgs/Vector3 angular_velocity\n"
                     "float64[9] angular_velocity_covariance\n"
                     "geometry_msgs/Vector3 linear_acceleration\n"
                     "float64[9] linear_acceleration_covariance\n",
                     {kHeader, kQuaternion, kVector3})};
}

MessageType joint_state_type() {
  return {"sensor_msgs/JointState", "3066dcd76a6cfaef579bd0f34173e9fd",
          definition("Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\n"
                     "float64[] effort\n",
                     {kHeader})};
}

MessageType odometry_type() {
  return {"nav_msgs/Odometry", "cd5e73d190d741a2f92e81eda573aca7",
          definition("Header header\nstring child_frame_id\n"
                     "geometry_msgs/PoseWithCovariance pose\n"
                     "geometry_msgs/TwistWithCovariance twist\n",
                     {kHeader, kPoseWithCovariance, kPose, kPoint, kQuaternion,
                      kTwistWithCovariance, kTwist, kVector3})};
}

MessageType transforms_type() {
  return {"tf2_msgs/TFMessage", "94810edda583a504dfda3829e70d7eec",
          definition("geometry_msgs/TransformStamped[] transforms\n",
                     {kTransformStamped, kHeader, kTransform, kVector3, kQuaternion})};
}

MessageType foot_contacts_type() {
  return {"aims_msgs/FootContacts", "48d94c73535758dc8b2afaab17ac6a45",
          definition("Header header\nstring[] foot\nbool[] contact\n", {kHeader})};
}

}  // namespace aims
