// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/topics/topic_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <functional>
#include <optional>
#include <set>

#include "recordings/messages/inertial_topics.hpp"
#include "recordings/messages/message_types.hpp"
#include "recordings/messages/robot_states.hpp"
#include "recordings/messages/words.hpp"
#include "recordings/topics/recording_topics.hpp"

namespace aims {
namespace {

constexpr std::string_view kNone = "none";
constexpr std::size_t kMaxListed = 60;

bool holds(std::string_view text, std::string_view part) {
  return std::search(text.begin(), text.end(), part.begin(), part.end(), [](char a, char b) {
           return std::tolower(static_cast<unsigned char>(a)) == b;
         }) != text.end();
}

bool is_cloud(const BagConnection& c) { return is_cloud_type(c.type); }
bool is_imu(const BagConnection& c) { return c.type == "sensor_msgs/Imu"; }
bool is_whole_imu(const BagConnection& c) {
  return is_imu(c) && (!inertial_half(c.topic) || c.topic.ends_with("/imu"));
}
const StateLayout* state_of(const BagConnection& c) { return robot_state_of(c.type, c.definition); }
bool has_imu(const StateLayout& state) { return !state.imu.empty(); }
bool has_joints(const StateLayout& state) { return state.has_joints(); }
bool has_feet(const StateLayout& state) { return state.has_feet(); }
bool has_contacts(const StateLayout& state) { return !state.contacts.empty(); }
bool is_state(const BagConnection& c, bool (*has)(const StateLayout&)) {
  const StateLayout* state = state_of(c);
  return state != nullptr && has(*state);
}
bool may_be_imu(const BagConnection& c) { return is_imu(c) || is_state(c, has_imu); }
bool is_odometry(const BagConnection& c) { return c.type == "nav_msgs/Odometry"; }
bool is_twist(const BagConnection& c) {
  return c.type == "geometry_msgs/TwistStamped" ||
         c.type == "geometry_msgs/TwistWithCovarianceStamped" || c.type == "geometry_msgs/Twist";
}
bool is_legs(const BagConnection& c) {
  return is_odometry(c) || is_twist(c) || is_state(c, has_feet);
}
bool is_joints(const BagConnection& c) { return c.type == "sensor_msgs/JointState"; }
bool may_be_joints(const BagConnection& c) { return is_joints(c) || is_state(c, has_joints); }
bool is_anything(const BagConnection&) { return true; }
bool is_truth(const BagConnection& c) {
  return is_odometry(c) || c.type == "geometry_msgs/PoseStamped" ||
         c.type == "geometry_msgs/PoseWithCovarianceStamped" ||
         c.type == "geometry_msgs/TransformStamped" || c.type == "geometry_msgs/PointStamped";
}
/// Names of ground truth, and of the motion captures that measure it.
bool is_called_truth(const BagConnection& c) {
  constexpr auto kNames = std::to_array<std::string_view>(
      {"truth", "mocap", "motion_capture", "vicon", "optitrack", "qualisys", "vrpn", "natnet"});
  const auto named = [&c](std::string_view name) { return holds(c.topic, name); };
  return std::ranges::any_of(kNames, named) || has_word(c.topic, "gt");
}
bool may_be_odometry(const BagConnection& c) { return is_odometry(c) && !is_called_truth(c); }
bool may_be_twist(const BagConnection& c) {
  return is_twist(c) && c.type != "geometry_msgs/Twist" && !holds(c.topic, "cmd") &&
         !is_called_truth(c);
}
bool may_be_contacts(const BagConnection& c) {
  return c.type == "aims_msgs/FootContacts" || holds(c.topic, "contact") ||
         holds(c.topic, "foot_force");
}

struct Request {
  std::string_view key;
  std::string_view expected;  ///< in words
  std::function<bool(const BagConnection&)> is_suitable;
};

std::string topic_list(std::span<const BagConnection> connections) {
  std::set<std::string> lines;
  for (const BagConnection& each : connections) {
    lines.insert(fmt::format("{} ({})", each.topic, each.type));
  }
  std::string text;
  std::size_t listed = 0;
  for (const std::string& line : lines) {
    if (listed++ == kMaxListed)
      return text + fmt::format(", and {} more", lines.size() - kMaxListed);
    text += (text.empty() ? "" : ", ") + line;
  }
  return text.empty() ? "no topic at all" : text;
}

/// Chooses topics of one bag.
class Chooser {
 public:
  Chooser(const std::filesystem::path& bag, std::span<const BagConnection> connections)
      : bag_(bag), connections_(connections) {}

  std::span<const BagConnection> connections() const { return connections_; }

  /// The requested topic, if it exists and has a suitable type.
  Result<std::string> requested(const Request& request, const std::string& topic) const {
    const auto found = find(topic);
    if (found == nullptr) {
      std::vector<std::string> names;
      for (const BagConnection& each : connections_) names.push_back(each.topic);
      const std::string near = near_match(topic, names);
      return failure(fmt::format(
          "{}: no topic '{}' (recording.topics.{}){}; it has {}", bag_.string(), topic, request.key,
          near.empty() ? "" : "; did you mean '" + near + "'?", topic_list(connections_)));
    }
    if (!request.is_suitable(*found)) {
      return failure(fmt::format("{}: topic '{}' (recording.topics.{}) is {}, expected {}",
                                 bag_.string(), topic, request.key, found->type, request.expected));
    }
    return topic;
  }

  /// The default topic, or the only suitable one, or nothing; several are an error.
  Result<std::string> found(const Request& request, std::string_view default_topic) const {
    const BagConnection* known = find(default_topic);
    const auto fits = [&request](const BagConnection& each) {
      return request.is_suitable(each) && !each.is_part;
    };
    if (known != nullptr && fits(*known)) return std::string(default_topic);
    std::set<std::string> topics;
    for (const BagConnection& each : connections_) {
      if (fits(each) && each.messages > 0) topics.insert(each.topic);
    }
    if (topics.empty()) return std::string();
    if (topics.size() == 1) return *topics.begin();
    std::string list;
    for (const std::string& topic : topics) list += (list.empty() ? "" : ", ") + topic;
    return failure(
        fmt::format("{}: several topics are {}: {}; choose one with recording.topics.{} (or none)",
                    bag_.string(), request.expected, list, request.key));
  }

  tl::unexpected<Error> missing(const Request& request) const {
    return failure(
        fmt::format("{}: no topic is {} (recording.topics.{}; 'none' to do without); it has {}",
                    bag_.string(), request.expected, request.key, topic_list(connections_)));
  }

  const BagConnection* find(std::string_view topic) const {
    const auto at = std::find_if(connections_.begin(), connections_.end(),
                                 [&](const BagConnection& each) { return each.topic == topic; });
    return at == connections_.end() ? nullptr : &*at;
  }

 private:
  const std::filesystem::path& bag_;
  std::span<const BagConnection> connections_;
};

/// The topic of a robot's state that has what is wanted, of the first such row; several of one row
/// are an error.
Result<std::string> state_topic(const Chooser& chooser, std::string_view key,
                                bool (*has)(const StateLayout&)) {
  for (const StateLayout& row : robot_states()) {
    if (!has(row)) continue;
    const auto is_of_row = [&row](const BagConnection& c) { return state_of(c) == &row; };
    auto topic = chooser.found({key, row.type, is_of_row}, row.topic);
    if (!topic || !topic->empty()) return topic;
  }
  return std::string();
}

/// The IMU, if need be that of a robot's state.
Result<std::string> imu_topic(const Chooser& chooser, const std::string& configured) {
  const Request request = {"imu", "sensor_msgs/Imu or a robot's state with an IMU", may_be_imu};
  if (configured == kNone) return std::string();
  if (!configured.empty()) return chooser.requested(request, configured);
  auto topic = chooser.found({"imu", "sensor_msgs/Imu", is_imu}, kImuTopic);
  // Gyro and accelerometer on a topic each are no IMU where both are joined.
  if (!topic) {
    const auto whole = chooser.found({"imu", "sensor_msgs/Imu", is_whole_imu}, kImuTopic);
    if (whole && !whole->empty()) topic = whole;
  }
  if (topic && topic->empty()) topic = state_topic(chooser, "imu", has_imu);
  if (topic && topic->empty()) return chooser.missing({"imu", "sensor_msgs/Imu", is_imu});
  return topic;
}

/// A required topic.
Result<std::string> required_topic(const Chooser& chooser, const Request& request,
                                   const std::string& configured, std::string_view default_topic) {
  if (configured == kNone) return std::string();
  if (!configured.empty()) return chooser.requested(request, configured);
  auto topic = chooser.found(request, default_topic);
  if (topic && topic->empty()) return chooser.missing(request);
  return topic;
}

Result<std::string> legs(const Chooser& chooser, const std::string& configured) {
  constexpr std::string_view kExpected =
      "nav_msgs/Odometry, geometry_msgs/TwistStamped or a robot's state with feet";
  if (configured == kNone) return std::string();
  if (!configured.empty())
    return chooser.requested({"leg_odometry", kExpected, is_legs}, configured);
  auto topic =
      chooser.found({"leg_odometry", "nav_msgs/Odometry", may_be_odometry}, kLegOdometryTopic);
  if (!topic || !topic->empty()) return topic;
  topic = chooser.found({"leg_odometry", "geometry_msgs/TwistStamped", may_be_twist}, "");
  if (!topic || !topic->empty()) return topic;
  // Joints give more than feet.
  topic = state_topic(chooser, "leg_odometry", has_joints);
  if (!topic) return topic;
  topic = topic->empty() ? state_topic(chooser, "leg_odometry", has_feet) : std::string();
  const bool joints = std::ranges::any_of(chooser.connections(), [](const BagConnection& each) {
    return is_joints(each) && each.messages > 0 && !each.is_part;
  });
  const auto* const found = topic ? chooser.find(*topic) : nullptr;
  return joints && found != nullptr && found->type == kFootPlaces ? std::string() : topic;
}

/// Joints or contacts of a robot's state where no other topic has them.
void add_state(const Chooser& chooser, const TopicsConfig& configured, TopicsConfig& topics) {
  if (configured.joint_states.empty() && topics.joint_states.empty()) {
    topics.joint_states = state_topic(chooser, "joint_states", has_joints).value_or("");
  }
  if (configured.contacts.empty() && topics.contacts.empty()) {
    topics.contacts = state_topic(chooser, "contacts", has_contacts).value_or("");
  }
}

/// An optional topic. Of several suitable ones none is chosen.
Result<std::string> optional_topic(const Chooser& chooser, const Request& request,
                                   const std::string& configured, std::string_view default_topic,
                                   bool (*is_likely)(const BagConnection&),
                                   std::vector<std::string>& notes) {
  if (configured == kNone) return std::string();
  if (!configured.empty()) return chooser.requested(request, configured);
  auto topic = chooser.found({request.key, request.expected, is_likely}, default_topic);
  if (topic) return topic;
  notes.push_back(topic.error().message.substr(topic.error().message.find("several topics")));
  return std::string();
}

/// Topics, each chosen whether or not others can be, and the first error.
struct Choice {
  TopicsConfig topics;
  std::optional<Error> error;

  void keep(std::string& member, const Result<std::string>& topic) {
    if (topic) {
      member = *topic;
    } else if (!error) {
      error = topic.error();
    }
  }
};

/// Poses that a topic's name says to be true are read only when asked for.
void note_possible_truth(const Chooser& chooser, std::vector<std::string>& notes) {
  for (const BagConnection& each : chooser.connections()) {
    const bool possible = is_truth(each) && is_called_truth(each) && each.messages > 0;
    if (!possible || each.topic == kTruthLidarTopic) continue;
    notes.push_back(
        fmt::format("{} may be the truth and is not read: to score against it, --topics truth={}",
                    each.topic, each.topic));
  }
}

/// Places of feet are not read where joints are recorded, be these of other limbs.
void note_unused_feet(const Chooser& chooser, std::vector<std::string>& notes) {
  for (const BagConnection& each : chooser.connections()) {
    if (each.type != kFootPlaces || each.messages == 0) continue;
    notes.push_back(fmt::format(
        "{} holds the places of the feet and is not read, since joints are recorded: to "
        "read it, --topics leg_odometry={}",
        each.topic, each.topic));
  }
}

Choice choice_of(const Chooser& chooser, const TopicsConfig& configured,
                 std::vector<std::string>& notes) {
  const Request lidar = {"lidar", "sensor_msgs/PointCloud2 or a livox CustomMsg", is_cloud};
  const Request joints = {"joint_states", "sensor_msgs/JointState or a robot's state with joints",
                          may_be_joints};
  const Request contacts = {"contacts", "contacts of feet", is_anything};
  Choice choice;
  TopicsConfig& topics = choice.topics;
  choice.keep(topics.lidar, required_topic(chooser, lidar, configured.lidar, kLidarTopic));
  choice.keep(topics.imu, imu_topic(chooser, configured.imu));
  choice.keep(topics.leg_odometry, legs(chooser, configured.leg_odometry));
  if (topics.leg_odometry.empty() && configured.leg_odometry.empty()) {
    note_unused_feet(chooser, notes);
  }
  choice.keep(topics.joint_states, optional_topic(chooser, joints, configured.joint_states,
                                                  kJointStatesTopic, is_joints, notes));
  choice.keep(topics.contacts, optional_topic(chooser, contacts, configured.contacts,
                                              kFootContactsTopic, may_be_contacts, notes));
  add_state(chooser, configured, topics);
  if (!configured.truth.empty() && configured.truth != kNone) {
    const Request truth = {
        "truth",
        "nav_msgs/Odometry or PoseStamped, PoseWithCovarianceStamped, TransformStamped or "
        "PointStamped of geometry_msgs (poses of tf: aims score --truth "
        "RECORDING:/tf:PARENT,CHILD)",
        is_truth};
    choice.keep(topics.truth, chooser.requested(truth, configured.truth));
  } else if (configured.truth.empty()) {
    const BagConnection* known = chooser.find(kTruthImuTopic);
    if (known != nullptr && is_truth(*known)) topics.truth = known->topic;
    if (topics.truth.empty()) note_possible_truth(chooser, notes);
  }
  return choice;
}

}  // namespace

bool is_cloud_type(std::string_view type) {
  return type == "sensor_msgs/PointCloud2" || type.ends_with("/CustomMsg");
}

bool is_imu_type(std::string_view type) {
  return type == "sensor_msgs/Imu" || is_robot_state_with_imu(type);
}

std::string_view type_of(std::span<const BagConnection> connections, std::string_view topic) {
  const auto at = std::find_if(connections.begin(), connections.end(),
                               [&](const BagConnection& each) { return each.topic == topic; });
  return at == connections.end() ? std::string_view() : std::string_view(at->type);
}

Result<TopicsConfig> choose_topics(const std::filesystem::path& bag,
                                   std::span<const BagConnection> connections,
                                   const TopicsConfig& configured,
                                   std::vector<std::string>& notes) {
  const Chooser chooser(bag, connections);
  Choice choice = choice_of(chooser, configured, notes);
  if (choice.error) return tl::unexpected(*choice.error);
  return std::move(choice.topics);
}

TopicsConfig unambiguous_topics(const std::filesystem::path& bag,
                                std::span<const BagConnection> connections,
                                const TopicsConfig& configured) {
  std::vector<std::string> notes;
  return choice_of(Chooser(bag, connections), configured, notes).topics;
}

}  // namespace aims
