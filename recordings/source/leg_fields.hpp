// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "recordings/messages/message_decoder.hpp"
#include "recordings/messages/message_view.hpp"

namespace aims {

/// What a message tells of one leg, or of one joint of it.
struct LegPartSample {
  Time time = 0;
  std::vector<std::string> names;              ///< of the joints, as recorded; may be empty
  std::vector<double> angles, rates, efforts;  ///< of its joints
  std::optional<double> load;                  ///< of its foot: a force, or 1 and 0
  std::optional<Eigen::Vector3d> place;        ///< of its foot, in the frame [m]
  std::string frame;                           ///< of the header
  std::string leg;  ///< what the message says of which leg it is: a field, a joint, the frame
};

/// The last name of a path of a field, in lower case without underscores.
std::string last_name(std::string_view path);

template <std::size_t kCount>
bool is_one_of(std::string_view name, const std::array<std::string_view, kCount>& names) {
  return std::ranges::find(names, name) != names.end();
}

/// Whether topic and type speak of a foot, and of no joint.
bool is_of_feet(std::string_view topic, std::string_view type);

/// Where the messages of a type hold a leg: paths of fields, empty where there is none.
class LegFields {
 public:
  /// By the names of the fields; they need not be of a leg. A position is one of a joint, unless
  /// topic and type speak of feet alone.
  LegFields(std::string_view topic, const std::string& type, const MessageDecoder& decoder);

  bool has_angles() const { return !angles_.empty(); }
  /// Whether a message holds a single joint.
  bool is_one_joint() const { return one_joint_; }
  bool has_leg() const { return !leg_.empty(); }
  bool has_load() const { return !load_.empty(); }
  bool has_place() const { return !place_.empty(); }

  /// Nothing for a message without the fields. `time`: without a stamp.
  std::optional<LegPartSample> read(const MessageView& message, Time time) const;

 private:
  enum class LoadKind { kNumber, kVector, kNumbers, kEntries };

  void take(const MessageField& field);
  void take_place(const MessageField& field, const std::string& name);
  std::optional<double> load_of(const MessageView& message) const;
  std::vector<double> joints_of(const MessageView& message, const std::string& path) const;
  std::string leg_of(const MessageView& message, const LegPartSample& sample) const;

  bool joint_state_ = false;  ///< a sensor_msgs/JointState
  bool plain_ = false;        ///< of std_msgs: the field is called "data"
  bool of_feet_ = false;      ///< by its topic and type
  bool one_joint_ = false;
  std::string angles_, rates_, efforts_, load_, place_, leg_;
  LoadKind load_kind_ = LoadKind::kNumber;
};

}  // namespace aims
