// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "recordings/messages/message_types.hpp"
#include "tests/recordings/legs/trot.hpp"
#include "tests/recordings/stream/recorded_deliveries.hpp"
#include "tests/recordings/stream/robot_recording.hpp"

namespace aims::test {

/// A trot recorded as sensor_msgs/JointState with torques of the knees, and forces of the feet.
struct TrotOptions {
  bool named = true;
  bool numbered = false;  ///< the names are "leg0_joint0", ...
  bool rates = true;
  double unit = 1.0;        ///< of the angles, in rad
  double rate_scale = 1.0;  ///< of the rates beside them
  std::vector<int> legs = {0, 1, 2, 3};
  std::array<int, kLegCount> feet = {0, 1, 2, 3};
  bool forces = true;
  double knee_sign = 1.0;
  float load = 60.0F;  ///< of a foot that stands
  float lifted = 0.0F;
  std::set<int> dead = {};  ///< feet whose load is lost
  int lost = 0;             ///< of so many messages of the joints one
  std::string single = {};  ///< each leg has messages of its own: their topic, with {} for the leg
  std::set<int> absent = {};         ///< legs that have no messages
  int dies = 1000;                   ///< message after which the rear right leg is silent
  bool on_change = false;            ///< loads are published only when a foot lands or lifts off
  std::string single_contacts = {};  ///< each foot has messages of its own: their topic, as above
  bool stance = false;               ///< contacts are fields that name the feet
  int batch = 1;  ///< so many messages are recorded at once, joints without a stamp
};

inline MessageBytes trot_joints(Time stamp, const Trot& trot, double time,
                                const TrotOptions& options) {
  MessageBytes out;
  out.put(std::uint32_t{0});
  out.time(stamp);
  out.text("base");
  std::vector<std::string> names;
  std::vector<double> position, velocity, effort;
  const JointVector q = trot.angles(time), dq = trot.rates(time);
  for (const int leg : options.legs) {
    constexpr std::array<const char*, kLegCount> kNames = {"FL", "FR", "RL", "RR"};
    constexpr std::array<const char*, 3> kParts = {"_hip", "_thigh", "_calf"};
    for (int part = 0; part < 3; ++part) {
      if (options.numbered) {
        names.push_back("leg" + std::to_string(names.size() / 3) + "_joint" + std::to_string(part));
      } else if (options.named) {
        names.push_back(std::string(kNames[static_cast<std::size_t>(leg)]) +
                        kParts[static_cast<std::size_t>(part)]);
      }
      position.push_back(q[3 * leg + part] / options.unit);
      if (options.rates) velocity.push_back(options.rate_scale * dq[3 * leg + part] / options.unit);
      const bool bears = part == 2 && trot.contact(time)[static_cast<std::size_t>(leg)];
      effort.push_back(bears ? -11.0 : 0.4);
    }
  }
  out.length(names.size());
  for (const std::string& name : names) out.text(name);
  for (const auto* each : {&position, &velocity, &effort}) out.array(*each);
  return out;
}

class RecordedTrot : public RecordingTest {
 protected:
  Recording read(const TrotOptions& options, RecordingConfig config = {}) {
    const auto file = write(options);
    config.topics.lidar = "none";
    if (options.forces) config.topics.contacts = "/foot_forces";
    return read_recording(file, config);
  }

  std::filesystem::path write(const TrotOptions& options) {
    const auto file = folder_.path() / (std::to_string(count_++) + ".bag");
    RobotRecording robot(file);
    robot.add_transforms(kMounted);
    std::vector<std::function<void()>> batch;  // messages that wait
    Time recorded = 0;
    const MessageType forces = {"std_msgs/Float32MultiArray", "6a40e0ffa6a17a503ac3f8616991b1f6",
                                "MultiArrayLayout layout\nfloat32[] data\n" + std::string(80, '=') +
                                    "\nMSG: std_msgs/MultiArrayLayout\nMultiArrayDimension[] dim\n"
                                    "uint32 data_offset\n" +
                                    std::string(80, '=') +
                                    "\nMSG: std_msgs/MultiArrayDimension\nstring label\n"
                                    "uint32 size\nuint32 stride\n"};
    const Trot trot = {.knee_sign = options.knee_sign};
    for (int k = 0; k < 400; ++k) {
      const Time now = kStart + k * 10 * kMillisecond;
      const double time = 0.01 * k + 0.003;
      recorded = now;
      robot.add_imu(now, 1);
      if (options.stance) {
        MessageBytes message;
        message.put(std::uint32_t{0});
        message.time(now);
        message.text("base");
        for (const std::size_t leg : {0, 2, 1, 3}) {
          message.put(trot.contact(time)[leg] ? 1.0F : 0.0F);
        }
        robot.add("/stance",
                  {"pronto_msgs/QuadrupedStance", "",
                   "Header header\nfloat32 lf\nfloat32 lh\nfloat32 rf\nfloat32 rh\n" +
                       std::string(80, '=') +
                       "\nMSG: std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id\n"},
                  now, message);
      }
      const bool changes = k == 0 || trot.contact(time) != trot.contact(time - 0.01);
      if (!options.single_contacts.empty() && (changes || !options.on_change)) {
        for (const int leg : {2, 0, 3, 1}) {
          MessageBytes message;
          message.put(static_cast<std::uint8_t>(trot.contact(time)[static_cast<std::size_t>(leg)]));
          robot.add(topic_of(options.single_contacts, leg),
                    {"std_msgs/Bool", "8b94c1b53db61fb6aed406028ad6332a", "bool data\n"}, now,
                    message);
        }
      }
      if (options.forces && (changes || !options.on_change)) {
        MessageBytes message;
        message.length(0);
        message.put(std::uint32_t{0});
        message.length(std::size_t{kLegCount});
        for (const int leg : options.feet) {
          const bool stands =
              trot.contact(time)[static_cast<std::size_t>(leg)] && !options.dead.contains(leg);
          message.put(stands ? options.load : options.lifted);
        }
        batch.push_back([&robot, &recorded, forces, message] {
          robot.add("/foot_forces", forces, recorded, message);
        });
      }
      if (options.lost > 0 && k % options.lost == 2) continue;
      const auto add_joints = [&](const std::string& topic, const TrotOptions& of) {
        const Time stamp = options.batch > 1 ? 0 : now;
        batch.push_back([&, topic, message = trot_joints(stamp, trot, time, of)] {
          robot.add(topic, joint_state_type(), recorded, message);
        });
      };
      if (options.single.empty()) add_joints("/joint_states", options);
      for (int leg = 0; leg < kLegCount && !options.single.empty(); ++leg) {
        if (options.absent.contains(leg) || (leg == 3 && k > options.dies)) continue;
        TrotOptions of = options;
        of.legs = {leg};
        add_joints(topic_of(options.single, leg), of);
      }
      if ((k + 1) % options.batch != 0) continue;
      for (const auto& add : batch) add();
      batch.clear();
    }
    robot.close();
    return file;
  }

  /// The topic of a leg.
  static std::string topic_of(std::string pattern, int leg) {
    constexpr std::array<const char*, kLegCount> kNames = {"fl", "fr", "rl", "rr"};
    const std::size_t at = pattern.find("{}");
    if (at != std::string::npos) pattern.replace(at, 2, kNames[static_cast<std::size_t>(leg)]);
    return pattern;
  }

 public:
  /// Mean velocity of the legs along x [m/s].
  static double speed(const Recording& read) {
    double sum = 0.0;
    const auto legs = legs_of(read.deliveries);
    for (const LegOdometrySample& each : legs) sum += each.linear_velocity.x();
    return sum / static_cast<double>(std::max<std::size_t>(1, legs.size()));
  }

 private:
  int count_ = 0;
};

}  // namespace aims::test
