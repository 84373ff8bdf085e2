// SPDX-License-Identifier: BSD-3-Clause
#include "tests/recordings/stream/robot_messages.hpp"

#include "tests/recordings/stream/message_fields.hpp"

namespace aims::test {
namespace {

constexpr std::array<int, kLegCount> kUnitreeLegs = {1, 0, 3, 2};  ///< FR, FL, RR, RL

const std::string kLegged =
    used("unitree_legged_msgs/IMU",
         "float32[4] quaternion\nfloat32[3] gyroscope\nfloat32[3] accelerometer\n"
         "float32[3] rpy\nint8 temperature") +
    used("unitree_legged_msgs/MotorState",
         "uint8 mode           # motor current mode\nfloat32 q            # rad\n"
         "float32 dq\nfloat32 ddq\nfloat32 tauEst\nfloat32 q_raw\nfloat32 dq_raw\n"
         "float32 ddq_raw\nint8 temperature\nuint32[2] reserve") +
    used("unitree_legged_msgs/BmsState",
         "uint8 version_h\nuint8 version_l\nuint8 bms_status\nuint8 SOC\nint32 current\n"
         "uint16 cycle\nint8[8] BQ_NTC\nint8[8] MCU_NTC\nuint16[30] cell_vol\n") +
    used("unitree_legged_msgs/Cartesian", "float32 x\nfloat32 y\nfloat32 z");

void put_imu(MessageBytes& out, const RobotSample& sample) {
  for (const float each : sample.quaternion) out.put(each);
  put_vector<float>(out, {0.0, 0.0, sample.turn_rate});
  put_vector<float>(out, {0.0, 0.0, 9.81});
  fill<float>(out, 3);
  out.put(std::int8_t{40});
}

/// 20 motors; those behind the twelfth are none.
void put_motors(MessageBytes& out, const RobotSample& sample) {
  for (int motor = 0; motor < 20; ++motor) {
    out.put(std::uint8_t{10});
    const bool exists = motor < kJointCount;
    const int joint =
        exists ? 3 * kUnitreeLegs[static_cast<std::size_t>(motor / 3)] + motor % 3 : 0;
    out.put(exists ? static_cast<float>(sample.angles[joint]) : 9.0F);
    out.put(exists ? static_cast<float>(sample.rates[joint]) : 9.0F);
    const bool bears =
        exists && motor % 3 == 2 && sample.contact[static_cast<std::size_t>(joint / 3)];
    out.put(0.0F);
    out.put(bears ? -11.0F : 0.4F);
    fill<float>(out, 3);
    out.put(std::int8_t{30});
    fill<std::uint32_t>(out, 2);
  }
}

void put_battery(MessageBytes& out) {
  fill<std::uint8_t>(out, 4, 1);
  out.put(std::int32_t{-1200});
  out.put(std::uint16_t{7});
  fill<std::int8_t>(out, 16, 25);
  fill<std::uint16_t>(out, 30, 3700);
}

/// Raw counts; offset and gain differ from foot to foot.
void put_forces(MessageBytes& out, const RobotSample& sample) {
  constexpr std::array<int, kLegCount> kOffset = {20, 5, 0, 33}, kGain = {90, 160, 60, 240};
  for (const int leg : kUnitreeLegs) {
    const auto i = static_cast<std::size_t>(leg);
    const int noise = sample.number % 7;
    const int load = kOffset[i] + noise + (sample.contact[i] ? kGain[i] : 0);
    out.put(static_cast<std::int16_t>(sample.has_foot_sensors ? load : 0));
  }
  fill<std::int16_t>(out, 4);
}

void put_feet(MessageBytes& out, const RobotSample& sample) {
  for (const auto* points : {&sample.feet, &sample.foot_speeds}) {
    for (const int leg : kUnitreeLegs) {
      put_vector<float>(out, (*points)[static_cast<std::size_t>(leg)]);
    }
  }
}

/// What a Go1 says of its motion, between the battery or the forces and the end.
void put_motion(MessageBytes& out) {
  out.put(std::uint8_t{2});
  fill<float>(out, 1);
  out.put(std::uint8_t{1});
  fill<float>(out, 9);
  fill<float>(out, 4);
}

void put_end(MessageBytes& out) {
  fill<std::uint8_t>(out, 40);
  fill<std::uint32_t>(out, 2);
}

const std::string kGo1Head =
    "uint8[2] head\nuint8 levelFlag\nuint8 frameReserve\n\nuint32[2] SN\nuint32[2] version\n"
    "uint16 bandWidth\nIMU imu\nMotorState[20] motorState\nBmsState bms\n"
    "int16[4] footForce\nint16[4] footForceEst\n";

const std::string kGo1Motion =
    "uint8 mode\nfloat32 progress\nuint8 gaitType\t\t   \nfloat32 footRaiseHeight\t\t  \n"
    "float32[3] position \nfloat32 bodyHeight\t\t\t  \nfloat32[3] velocity \n"
    "float32 yawSpeed\t\t\t\t   \nfloat32[4] rangeObstacle\nCartesian[4] footPosition2Body \n"
    "Cartesian[4] footSpeed2Body\t\nuint8[40] wirelessRemote\nuint32 reserve\n\nuint32 crc";

void put_go1(MessageBytes& out, const RobotSample& sample) {
  fill<std::uint8_t>(out, 4, 0xfe);
  fill<std::uint32_t>(out, 4, 1);
  out.put(std::uint16_t{9});
  put_imu(out, sample);
  put_motors(out, sample);
  put_battery(out);
  put_forces(out, sample);
}

void put_go1_high(MessageBytes& out, const RobotSample& sample) {
  put_go1(out, sample);
  put_motion(out);
  put_feet(out, sample);
  put_end(out);
}

void put_old_head(MessageBytes& out) {
  out.put(std::uint8_t{0xee});
  fill<std::uint16_t>(out, 2, 1);
  out.put(std::uint32_t{5});
  out.put(std::uint8_t{3});
}

}  // namespace

RobotMessage go1_high_state() {
  return {"go1_high_state",
          {"unitree_legged_msgs/HighState", "", kGo1Head + kGo1Motion + kLegged},
          [](const RobotSample& sample) {
            MessageBytes out;
            put_go1_high(out, sample);
            return out;
          }};
}

RobotMessage leg_kilo_high_state() {
  return {"leg_kilo_high_state",
          {"unitree_legged_msgs/HighState", "", "time stamp\n" + kGo1Head + kGo1Motion + kLegged},
          [](const RobotSample& sample) {
            MessageBytes out;
            out.time(sample.stamp);
            put_go1_high(out, sample);
            return out;
          }};
}

RobotMessage fusion_portable_high_state() {
  const std::string fields =
      "Header header\nuint8 levelFlag\nuint16 commVersion   # Old version Aliengo does not have\n"
      "uint16 robotID\nuint32 SN\nuint8 bandWidth\nuint8 mode\nuint8 gaitType\nIMU imu\n"
      "MotorState[20] motorState\nint16[4] footForce\nint16[4] footForceEst\nfloat32 progress\n"
      "float32[3] position\nfloat32[3] velocity\nfloat32 bodyHeight\nfloat32 footRaiseHeight\n"
      "float32 yawSpeed\nCartesian[4] footPosition2Body\nCartesian[4] footSpeed2Body\n"
      "uint8[40] wirelessRemote\nuint32 reserve\nuint32 crc\nCartesian[4] eeForce\n"
      "float32[12] jointP              # for visualization";
  return {"fusion_portable_high_state",
          {"unitree_legged_msgs/HighState", "", fields + kLegged + used_header()},
          [](const RobotSample& sample) {
            MessageBytes out;
            put_header(out, sample.stamp, "body");
            put_old_head(out);
            fill<std::uint8_t>(out, 2, 1);
            put_imu(out, sample);
            put_motors(out, sample);
            put_forces(out, sample);
            fill<float>(out, 10);
            put_feet(out, sample);
            put_end(out);
            fill<float>(out, 24);
            return out;
          }};
}

RobotMessage feet_high_state() {
  const std::string fields =
      "uint8 levelFlag\nuint16 commVersion\nuint16 robotID\nuint32 SN\nuint8 bandWidth\n"
      "uint8 mode\nfloat32 progress\nIMU imu\nuint8 gaitType\nfloat32 footRaiseHeight\n"
      "float32[3] position\nfloat32 bodyHeight\nfloat32[3] velocity\nfloat32 yawSpeed\n"
      "Cartesian[4] footPosition2Body\nCartesian[4] footSpeed2Body\n#int8[20] temperature\n"
      "BmsState bms\nint16[4] footForce\nint16[4] footForceEst\nuint8[40] wirelessRemote\n"
      "uint32 reserve\nuint32 crc";
  return {"feet_high_state",
          {"unitree_legged_msgs/HighState", "", fields + kLegged},
          [](const RobotSample& sample) {
            MessageBytes out;
            put_old_head(out);
            out.put(std::uint8_t{2});
            fill<float>(out, 1);
            put_imu(out, sample);
            out.put(std::uint8_t{1});
            fill<float>(out, 9);
            put_feet(out, sample);
            put_battery(out);
            put_forces(out, sample);
            put_end(out);
            return out;
          }};
}

RobotMessage go1_low_state() {
  return {"go1_low_state",
          {"unitree_legged_msgs/LowState", "",
           kGo1Head + "uint32 tick\t\t\nuint8[40] wirelessRemote \nuint32 reserve\n\nuint32 crc\n" +
               kLegged},
          [](const RobotSample& sample) {
            MessageBytes out;
            put_go1(out, sample);
            fill<std::uint32_t>(out, 1);
            put_end(out);
            return out;
          }};
}

RobotMessage a1_low_state() {
  const std::string fields =
      "uint8 levelFlag\nuint16 commVersion\nuint16 robotID\nuint32 SN \nuint8 bandWidth\n"
      "IMU imu\nMotorState[20] motorState\nint16[4] footForce              # force sensors\n"
      "int16[4] footForceEst\nuint32 tick\nuint8[40] wirelessRemote\nuint32 reserve\nuint32 crc\n"
      "\n\nCartesian[4] eeForceRaw\nCartesian[4] eeForce\nCartesian position\n"
      "Cartesian velocity\nCartesian velocity_w            # will delete\n";
  return {"a1_low_state",
          {"unitree_legged_msgs/LowState", "", fields + kLegged},
          [](const RobotSample& sample) {
            MessageBytes out;
            put_old_head(out);
            put_imu(out, sample);
            put_motors(out, sample);
            put_forces(out, sample);
            fill<std::uint32_t>(out, 1);
            put_end(out);
            fill<float>(out, 33);
            return out;
          }};
}

}  // namespace aims::test
