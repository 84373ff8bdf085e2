// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/trajectories/bag_trajectory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <utility>

#include "core/files/pose_cleaning.hpp"
#include "recordings/messages/message_values.hpp"
#include "recordings/source/recording_file.hpp"
#include "recordings/topics/connection_decoders.hpp"
#include "recordings/trajectories/tf_trajectory.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

/// Fields of the pose in a message type.
struct PoseLayout {
  std::string_view type;
  std::string_view position;
  std::string_view rotation;  ///< empty: the message has a position alone
};

constexpr std::string_view kPath = "nav_msgs/Path";
constexpr std::array<PoseLayout, 6> kLayouts = {{
    {"nav_msgs/Odometry", "pose.pose.position", "pose.pose.orientation"},
    {"geometry_msgs/PoseStamped", "pose.position", "pose.orientation"},
    {"geometry_msgs/PoseWithCovarianceStamped", "pose.pose.position", "pose.pose.orientation"},
    {"geometry_msgs/TransformStamped", "transform.translation", "transform.rotation"},
    {kPath, "pose.position", "pose.orientation"},
    {"geometry_msgs/PointStamped", "point", ""},
}};

const PoseLayout* layout_of(const std::string& type) {
  const auto found = std::find_if(kLayouts.begin(), kLayouts.end(),
                                  [&type](const PoseLayout& each) { return each.type == type; });
  return found == kLayouts.end() ? nullptr : &*found;
}

std::string listed(const std::vector<BagConnection>& connections, bool poses_only) {
  std::vector<std::string> names;
  for (const BagConnection& each : connections) {
    std::string name = fmt::format("{} ({})", each.topic, each.type);
    const bool known = std::find(names.begin(), names.end(), name) != names.end();
    if (!known && (!poses_only || layout_of(each.type) != nullptr))
      names.push_back(std::move(name));
  }
  return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
}

std::string wanted_types() {
  std::vector<std::string_view> types;
  for (const PoseLayout& layout : kLayouts) types.push_back(layout.type);
  return fmt::format("{}", fmt::join(types, ", "));
}

/// Topics of the bag with poses; without any, those with positions.
std::vector<std::string> topics_with_poses(const MessageSource& bag) {
  std::vector<std::string> poses, positions;
  for (const BagConnection& each : bag.connections()) {
    const PoseLayout* layout = layout_of(each.type);
    if (layout == nullptr) continue;
    std::vector<std::string>& list = layout->rotation.empty() ? positions : poses;
    if (std::find(list.begin(), list.end(), each.topic) == list.end()) list.push_back(each.topic);
  }
  return poses.empty() ? positions : poses;
}

/// The topic to read: the given one, the only one with poses, or the preferred one.
Result<std::string> choose_topic(const MessageSource& bag, const std::string& given,
                                 const std::string& preferred, std::vector<std::string>& notes) {
  const std::string name = bag.name();
  for (const BagConnection& each : bag.connections()) {
    if (given.empty() || each.topic != given) continue;
    if (layout_of(each.type) != nullptr) return given;
    return failure(fmt::format("{}: topic {} is {}; expected one of {}", name, given, each.type,
                               wanted_types()));
  }
  const std::vector<std::string> fitting = topics_with_poses(bag);
  const auto has = [&fitting](const std::string& topic) {
    return std::find(fitting.begin(), fitting.end(), topic) != fitting.end();
  };
  if (!given.empty()) {
    return failure(fmt::format("{}: no topic {}; there are {}", name, given,
                               listed(bag.connections(), false)));
  }
  if (fitting.size() == 1) return fitting.front();
  if (has(preferred)) {
    notes.push_back(fmt::format("{}: topic {} chosen of several with poses", name, preferred));
    return preferred;
  }
  if (fitting.empty()) {
    return failure(fmt::format("{}: no topic with poses ({}); there are {}", name, wanted_types(),
                               listed(bag.connections(), false)));
  }
  return failure(fmt::format(
      "{}: several topics with poses; expected one of them behind a colon, "
      "as {}:{}; there are {}",
      name, fs::path(name).filename().string(), fitting.front(), listed(bag.connections(), true)));
}

/// A quaternion whose norm is 1 within float32 rounding is normalized; others stay unchanged.
std::optional<StampedPose> pose_in(const MessageView& view, const PoseLayout& layout) {
  const auto stamp = view.time("header.stamp");
  const auto position = vector_at(view, layout.position);
  if (!stamp || !position) return std::nullopt;
  if (layout.rotation.empty()) {
    return StampedPose{*stamp, {Eigen::Quaterniond::Identity(), *position}};
  }
  auto rotation = quaternion_at(view, layout.rotation);
  if (!rotation) return std::nullopt;
  const double off = std::abs(rotation->norm() - 1.0);
  if (off > 1e-14 && off < 1e-3) rotation->normalize();
  return StampedPose{*stamp, {*rotation, *position}};
}

/// Reads the poses of one topic.
class TopicReader {
 public:
  TopicReader(MessageSource& bag, std::string topic) : bag_(bag), topic_(std::move(topic)) {}

  /// Appends every pose and its record time; of paths only those of the last one.
  Result<void> read(Trajectory& poses, std::vector<Time>& record_times) {
    bag_.select({&topic_, 1});
    std::vector<std::byte> path;  // the last one, since each repeats the poses before
    BagMessage last_path;
    while (true) {
      const auto message = bag_.next();
      if (!message) return tl::unexpected(message.error());
      if (!*message) break;
      const PoseLayout* layout = layout_of((*message)->connection->type);
      if (layout == nullptr) continue;
      if (layout->type == kPath) {
        path.assign((*message)->data.begin(), (*message)->data.end());
        last_path = **message;
      } else if (auto added = add(**message, *layout, poses, record_times); !added) {
        return added;
      }
    }
    if (last_path.connection == nullptr) return {};
    last_path.data = path;
    return add_path(last_path, poses, record_times);
  }

  /// From the first message that names one; e.g. "imu".
  const std::string& body_frame() const { return body_frame_; }

 private:
  Result<MessageView> decode(const BagMessage& message) {
    auto view = decoders_.decode(message);
    if (!view) return error(message, view.error().message);
    return view;
  }

  Result<void> add(const BagMessage& message, const PoseLayout& layout, Trajectory& poses,
                   std::vector<Time>& record_times) {
    const auto view = decode(message);
    if (!view) return tl::unexpected(view.error());
    const auto pose = pose_in(*view, layout);
    if (!pose) return error(message, fmt::format("expected a pose in '{}'", layout.position));
    if (body_frame_.empty()) body_frame_ = view->text("child_frame_id").value_or("");
    poses.push_back(*pose);
    record_times.push_back(message.record_time);
    return {};
  }

  Result<void> add_path(const BagMessage& message, Trajectory& poses,
                        std::vector<Time>& record_times) {
    const auto view = decode(message);
    if (!view) return tl::unexpected(view.error());
    const auto entries = view->messages("poses");
    if (!entries) return error(message, "expected an array 'poses'");
    for (const MessageView& each : *entries) {
      const auto pose = pose_in(each, *layout_of(std::string(kPath)));
      if (!pose) return error(message, "expected poses in 'poses'");
      poses.push_back(*pose);
      record_times.push_back(message.record_time);
    }
    return {};
  }

  tl::unexpected<Error> error(const BagMessage& message, const std::string& what) const {
    return failure(fmt::format("{}: chunk at {}: {} ({}): {}", bag_.name(), message.offset, topic_,
                               message.connection->type, what));
  }

  MessageSource& bag_;
  std::string topic_;
  std::string body_frame_;
  ConnectionDecoders decoders_;
};

/// Uses record times as stamps if all header stamps are zero.
void stamp_by_record_time(Trajectory& poses, const std::vector<Time>& record_times,
                          const std::string& name, std::vector<std::string>& notes) {
  const bool any = std::any_of(poses.begin(), poses.end(),
                               [](const StampedPose& each) { return each.stamp != 0; });
  if (any || poses.size() < 2) return;
  for (std::size_t i = 0; i < poses.size(); ++i) poses[i].stamp = record_times[i];
  notes.push_back(fmt::format("{}: headers have no stamps: record times are used", name));
}

}  // namespace

Result<TrajectoryFile> read_bag_trajectory(const fs::path& file, const std::string& topic,
                                           const TrajectoryFileOptions& options) {
  if (names_transforms(topic)) return read_tf_trajectory(file, topic, options);
  auto bag = open_recording(file);
  if (!bag) return tl::unexpected(bag.error());
  TrajectoryFile result;
  result.file = file;
  const auto chosen = choose_topic(**bag, topic, options.preferred_topic, result.notes);
  if (!chosen) return tl::unexpected(chosen.error());
  result.topic = *chosen;
  const auto connection =
      std::find_if((*bag)->connections().begin(), (*bag)->connections().end(),
                   [&](const BagConnection& each) { return each.topic == *chosen; });
  result.kind = fmt::format("{} on {}", connection->type, *chosen);
  result.has_attitude = !layout_of(connection->type)->rotation.empty();
  std::vector<Time> record_times;
  TopicReader reader(**bag, *chosen);
  auto read = reader.read(result.trajectory, record_times);
  if (!read) return tl::unexpected(read.error());
  result.body_frame = reader.body_frame();
  const std::string name = fmt::format("{}:{}", file.string(), *chosen);
  if (result.trajectory.empty()) return failure(name + ": expected poses, found none");
  stamp_by_record_time(result.trajectory, record_times, name, result.notes);
  if (options.rules == PoseRules::kStrict && result.has_attitude) {
    result.has_attitude = !is_of_positions(result.trajectory, name, result.notes);
  }
  normalize_rounded(result.trajectory, name, result.notes);
  if (options.rules == PoseRules::kStrict) {
    result.dropped = drop_unusable(result.trajectory, name, result.notes);
  }
  return result;
}

Result<std::optional<std::string>> read_bag_text(const fs::path& file, const std::string& topic,
                                                 const BagOpenOptions& options) {
  auto bag = open_recording(file, options);
  if (!bag) return tl::unexpected(bag.error());
  (*bag)->select({&topic, 1});
  ConnectionDecoders decoders;
  std::optional<std::string> text;
  while (true) {
    const auto message = (*bag)->next();
    if (!message) return tl::unexpected(message.error());
    if (!*message) return text;
    const auto view = decoders.decode(**message);
    const auto data = view ? view->text("data") : std::nullopt;
    if (!data) {
      return failure(fmt::format("{}: {}: expected a std_msgs/String, found {}", file.string(),
                                 topic, (*message)->connection->type));
    }
    text = std::string(*data);
  }
}

}  // namespace aims
