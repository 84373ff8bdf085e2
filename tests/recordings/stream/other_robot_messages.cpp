// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>

#include "tests/recordings/stream/message_fields.hpp"
#include "tests/recordings/stream/robot_messages.hpp"

namespace aims::test {
namespace {

/// The straight knee of an ANYmal: its foot lies 0.08795 m before the shank, of 0.33797 m.
double anymal_knee(int joint) {
  if (joint % 3 != 2) return 0.0;
  return (joint < 6 ? 1.0 : -1.0) * std::atan2(0.08795, 0.33797);
}

std::string geometry_types() {
  return used("geometry_msgs/PoseStamped", "Header header\nPose pose\n") +
         used("geometry_msgs/Pose", "Point position\nQuaternion orientation\n") +
         used_vector("geometry_msgs/Point") +
         used("geometry_msgs/Quaternion", "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n") +
         used("geometry_msgs/TwistStamped", "Header header\nTwist twist\n") +
         used("geometry_msgs/Twist", "Vector3 linear\nVector3 angular\n") +
         used_vector("geometry_msgs/Vector3") +
         used("geometry_msgs/Wrench", "Vector3 force\nVector3 torque\n") +
         used("geometry_msgs/TransformStamped",
              "Header header\nstring child_frame_id\nTransform transform\n") +
         used("geometry_msgs/Transform", "Vector3 translation\nQuaternion rotation\n");
}

void put_pose_and_twist(MessageBytes& out, Time stamp) {
  put_header(out, stamp, "odom");
  fill<double>(out, 6);
  out.put(1.0);
  put_header(out, stamp, "base");
  fill<double>(out, 6);
}

void put_joints(MessageBytes& out, const RobotSample& sample,
                const std::vector<std::string>& names) {
  put_header(out, sample.stamp, "");
  out.length(names.size());
  for (const std::string& name : names) out.text(name);
  std::vector<double> angles, rates;
  for (int joint = 0; joint < kJointCount; ++joint) {
    angles.push_back(sample.angles[joint] + anymal_knee(joint));
    rates.push_back(sample.rates[joint]);
  }
  const std::vector<double> none(angles.size());
  for (const std::vector<double>& each : {angles, rates, none, none}) out.array(each);
}

void put_contacts(MessageBytes& out, const RobotSample& sample,
                  const std::vector<std::string>& names) {
  out.length(names.size());
  for (std::size_t leg = 0; leg < names.size(); ++leg) {
    put_header(out, sample.stamp, "odom");
    out.text(names[leg]);
    // STATE_OPEN, or while the foot stands STATE_CLOSED; what slips does not stand.
    const bool slips = !sample.contact[leg] && sample.number % 2 == 0;
    out.put(static_cast<std::uint8_t>(sample.contact[leg] ? 1 : slips ? 2 : 0));
    fill<double>(out, 14);
  }
}

}  // namespace

std::vector<std::string> anymal_joints() {
  std::vector<std::string> names;
  for (const std::string leg : {"LF", "RF", "LH", "RH"}) {
    for (const char* part : {"_HAA", "_HFE", "_KFE"}) names.push_back(leg + part);
  }
  return names;
}

std::vector<std::string> anymal_feet() { return {"LF_FOOT", "RF_FOOT", "LH_FOOT", "RH_FOOT"}; }

RobotMessage anymal_state(const std::vector<std::string>& joints,
                          const std::vector<std::string>& feet, const std::string& package) {
  const std::string joint_type = package + "/ExtendedJointState";
  const std::string fields =
      "# Anymal state\nHeader header\nint8 STATE_ERROR_SENSOR = -3\nint8 STATE_OK = 0\n"
      "int8 STATE_UNINITIALIZED = 1 \nint8 state\n\ngeometry_msgs/PoseStamped pose\n"
      "geometry_msgs/TwistStamped twist\n" +
      joint_type + " joints\nContact[] contacts\ngeometry_msgs/TransformStamped[] frame_transforms";
  const std::string others =
      used(joint_type,
           "std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\n"
           "float64[] acceleration\nfloat64[] effort\n") +
      used("anymal_msgs/Contact",
           "# Contact definition\nuint8 STATE_OPEN=0\nuint8 STATE_CLOSED=1\n"
           "uint8 STATE_SLIPPING=2\n\nstd_msgs/Header header\nstring name\nuint8 state\n"
           "geometry_msgs/Wrench wrench\ngeometry_msgs/Point position\n"
           "geometry_msgs/Vector3 normal\nfloat64 frictionCoefficient\n"
           "float64 restitutionCoefficient\n") +
      used_header() + geometry_types();
  return {"anymal_state_" + package,
          {"anymal_msgs/AnymalState", "", fields + others},
          [joints, feet](const RobotSample& sample) {
            MessageBytes out;
            put_header(out, sample.stamp, "odom");
            out.put(std::int8_t{0});
            put_pose_and_twist(out, sample.stamp);
            put_joints(out, sample, joints);
            put_contacts(out, sample, feet);
            out.length(0);
            return out;
          }};
}

RobotMessage actuator_readings() {
  const std::string state =
      "std_msgs/Header header\nstring name\nuint32 statusword\nfloat64 current\n"
      "float64 gear_position\nfloat64 gear_velocity\nfloat64 joint_position\n"
      "float64 joint_velocity\nfloat64 joint_acceleration\nfloat64 joint_torque\n";
  const std::string package = "series_elastic_actuator_msgs/";
  const std::string definition =
      "SeActuatorReading[] readings" +
      used(package + "SeActuatorReading", "std_msgs/Header header\nSeActuatorState state\n") +
      used(package + "SeActuatorState", state) + used_header();
  return {"actuator_readings",
          {package + "SeActuatorReadings", "", definition},
          [](const RobotSample& sample) {
            MessageBytes out;
            const auto names = anymal_joints();
            out.length(names.size());
            for (int joint = 0; joint < kJointCount; ++joint) {
              put_header(out, sample.stamp, "");
              put_header(out, sample.stamp, "");
              out.text(names[static_cast<std::size_t>(joint)]);
              out.put(std::uint32_t{0});
              fill<double>(out, 3);
              out.put(sample.angles[joint] + anymal_knee(joint));
              out.put(sample.rates[joint]);
              out.put(0.0);
              const bool bears =
                  joint % 3 == 2 && sample.contact[static_cast<std::size_t>(joint / 3)];
              out.put((joint < 6 ? 1.0 : -1.0) * (bears ? 45.0 : 2.0));
            }
            return out;
          }};
}

RobotMessage spot_feet() {
  const std::string definition =
      "FootState[] states\n" +
      used("spot_msgs/FootState",
           "# Contact\nuint8 CONTACT_UNKNOWN = 0\nuint8 CONTACT_MADE = 1\n"
           "uint8 CONTACT_LOST = 2\n\ngeometry_msgs/Point foot_position_rt_body\n"
           "uint8 contact\nspot_msgs/TerrainState terrain\n") +
      used("spot_msgs/TerrainState",
           "float32 ground_mu_est\nstring frame_name\n"
           "geometry_msgs/Vector3 foot_slip_distance_rt_frame\n"
           "geometry_msgs/Vector3 foot_slip_velocity_rt_frame\n"
           "geometry_msgs/Vector3 ground_contact_normal_rt_frame\n"
           "float32 visual_surface_ground_penetration_mean\n"
           "float32 visual_surface_ground_penetration_std") +
      used_vector("geometry_msgs/Point") + used_vector("geometry_msgs/Vector3");
  return {"spot_feet", {"spot_msgs/FootStateArray", "", definition}, [](const RobotSample& sample) {
            MessageBytes out;
            out.length(kLegCount);
            for (std::size_t leg = 0; leg < std::size_t{kLegCount}; ++leg) {
              put_vector<double>(out, sample.feet[leg]);
              out.put(static_cast<std::uint8_t>(sample.contact[leg] ? 1 : 2));
              out.put(0.6F);
              out.text("odom");
              fill<double>(out, 9);
              fill<float>(out, 2);
            }
            return out;
          }};
}

RobotMessage humanoid_state() {
  const std::string definition =
      "uint32[2] version\nuint8 mode_pr\nuint8 mode_machine\nuint32 tick\nIMUState imu_state\n"
      "MotorState[35] motor_state\nuint8[40] wireless_remote\nuint32[4] reserve\nuint32 crc" +
      used("unitree_hg/IMUState",
           "float32[4] quaternion\nfloat32[3] gyroscope\nfloat32[3] accelerometer\n"
           "float32[3] rpy\nint16 temperature\n") +
      used("unitree_hg/MotorState",
           "uint8 mode\nfloat32 q\nfloat32 dq\nfloat32 ddq\nfloat32 tau_est\n\n"
           "int16[2] temperature\nfloat32 vol\nuint32[2] sensor\nuint32 motorstate\n"
           "uint32[4] reserve");
  return {"humanoid_state", {"unitree_hg/LowState", "", definition}, [](const RobotSample& sample) {
            MessageBytes out;
            fill<std::uint32_t>(out, 2, 1);
            fill<std::uint8_t>(out, 2, 5);
            out.put(std::uint32_t{17});
            for (const float each : {1.0F, 0.0F, 0.0F, 0.0F}) out.put(each);
            put_vector<float>(out, {0.0, 0.0, sample.turn_rate});
            put_vector<float>(out, {0.0, 0.0, 9.81});
            fill<float>(out, 3);
            out.put(std::int16_t{35});
            for (int motor = 0; motor < 35; ++motor) {
              const bool leg = motor < kJointCount;
              out.put(std::uint8_t{1});
              out.put(leg ? static_cast<float>(sample.angles[motor]) : 0.0F);
              out.put(leg ? static_cast<float>(sample.rates[motor]) : 0.0F);
              out.put(0.0F);
              const bool bears =
                  leg && motor % 6 == 3 && sample.contact[static_cast<std::size_t>(motor / 6)];
              out.put(bears ? 38.0F : 3.0F);
              fill<std::int16_t>(out, 2, 40);
              out.put(48.0F);
              fill<std::uint32_t>(out, 7);
            }
            fill<std::uint8_t>(out, 40);
            fill<std::uint32_t>(out, 5);
            return out;
          }};
}

}  // namespace aims::test
