// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/trajectories/tf_trajectory.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "core/files/pose_cleaning.hpp"
#include "recordings/frames/frame_tree.hpp"
#include "recordings/messages/message_values.hpp"
#include "recordings/source/recording_file.hpp"
#include "recordings/topics/connection_decoders.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kStaticTopic = "/tf_static";

/// A parent and its child.
using Link = std::pair<std::string, std::string>;

std::string plain(std::string_view frame) {
  if (frame.starts_with('/')) frame.remove_prefix(1);
  return std::string(frame);
}

/// All transforms of a recording, link by link.
class Transforms {
 public:
  void add(const FrameTransform& each, Time stamp) {
    const Link link{plain(each.parent), plain(each.child)};
    if (!tree_.add(link.first, link.second, each.T_parent_child)) return;
    Trajectory& poses = links_[link];
    if (!poses.empty() && stamp <= poses.back().stamp) return;
    poses.push_back({stamp, each.T_parent_child});
    Eigen::Quaterniond& rotation = poses.back().pose.rotation;
    if (is_off_unit(rotation)) rotation.normalize();
  }

  /// The links of the chain from `from` to `to`, with whether each is passed from child to parent.
  std::vector<std::pair<Link, bool>> chain(const std::string& from, const std::string& to) const {
    std::vector<std::pair<Link, bool>> steps;
    const std::vector<std::string> frames = tree_.chain(from, to);
    for (std::size_t i = 1; i < frames.size(); ++i) {
      const Link down{frames[i - 1], frames[i]};
      const bool up = !links_.contains(down);
      steps.emplace_back(up ? Link{down.second, down.first} : down, up);
    }
    return steps;
  }

  const Trajectory& of(const Link& link) const { return links_.at(link); }

  /// The links that change.
  std::vector<Link> moving() const {
    std::vector<Link> found;
    for (const auto& [link, poses] : links_) {
      if (poses.size() > 1) found.push_back(link);
    }
    return found;
  }

  std::string names() const {
    std::vector<std::string> pairs;
    for (const auto& [link, poses] : links_) {
      pairs.push_back(fmt::format("{},{}", link.first, link.second));
    }
    return pairs.empty() ? "none" : fmt::format("{}", fmt::join(pairs, " "));
  }

 private:
  FrameTree tree_;
  std::map<Link, Trajectory> links_;
};

Result<Transforms> read_transforms(const fs::path& file, const std::string& topic) {
  auto bag = open_recording(file);
  if (!bag) return tl::unexpected(bag.error());
  const std::array<std::string, 2> topics = {topic, std::string(kStaticTopic)};
  (*bag)->select(topics);
  Transforms transforms;
  ConnectionDecoders decoders;
  while (true) {
    const auto message = (*bag)->next();
    if (!message) return tl::unexpected(message.error());
    if (!*message) return transforms;
    const auto view = decoders.decode(**message);
    if (!view) return tl::unexpected(view.error());
    const auto stamped = view->messages("transforms");
    if (!stamped) {
      return failure(fmt::format("{}: topic {} is {}; expected tf2_msgs/TFMessage", file.string(),
                                 (*message)->connection->topic, (*message)->connection->type));
    }
    std::size_t index = 0;
    for (const FrameTransform& each : transforms_in(*view)) {
      transforms.add(each, header_stamp((*stamped)[index++], (*message)->record_time));
    }
  }
}

/// The pose of a link at the stamp; of one that never changes, its only one.
std::optional<Pose> link_at(const Trajectory& poses, Time stamp) {
  if (poses.size() == 1) return poses.front().pose;
  return pose_at(poses, stamp);
}

Trajectory composed(const Transforms& transforms, const std::vector<std::pair<Link, bool>>& chain) {
  const auto fastest = std::ranges::max_element(
      chain, {}, [&](const auto& step) { return transforms.of(step.first).size(); });
  Trajectory result;
  for (const StampedPose& each : transforms.of(fastest->first)) {
    std::optional<Pose> total = Pose();
    for (const auto& [link, up] : chain) {
      const auto step = link_at(transforms.of(link), each.stamp);
      if (!step) total.reset();
      if (!step) break;
      *total = *total * (up ? step->inverse() : *step);
    }
    if (total) result.push_back({each.stamp, *total});
  }
  return result;
}

}  // namespace

bool names_transforms(const std::string& topic) {
  const std::string name = topic.substr(0, topic.find(':'));
  return name == "/tf" || name == "tf" || topic.find(':') != std::string::npos;
}

Result<TrajectoryFile> read_tf_trajectory(const fs::path& file, const std::string& topic,
                                          const TrajectoryFileOptions& options) {
  TrajectoryFile result;
  result.file = file;
  const std::size_t colon = topic.find(':');
  result.topic = topic.substr(0, colon);
  const auto transforms = read_transforms(file, result.topic);
  if (!transforms) return tl::unexpected(transforms.error());
  const std::string frames = colon == std::string::npos ? "" : topic.substr(colon + 1);
  const std::size_t comma = frames.find(',');
  Link wanted{plain(frames.substr(0, comma)), plain(frames.substr(std::min(comma, frames.size())))};
  if (comma != std::string::npos) wanted.second = plain(frames.substr(comma + 1));
  const std::vector<Link> moving = transforms->moving();
  const std::string name = fmt::format("{}:{}", file.string(), topic);
  if (frames.empty() && moving.size() == 1) wanted = moving.front();
  const auto chain = transforms->chain(wanted.first, wanted.second);
  if (chain.empty()) {
    return failure(
        fmt::format("{}: expected two connected frames, as {}:PARENT,CHILD; there are {}", name,
                    fs::path(file).filename().string() + ":" + result.topic, transforms->names()));
  }
  result.trajectory = composed(*transforms, chain);
  result.kind = fmt::format("{} in {} of {}", wanted.second, wanted.first, result.topic);
  result.body_frame = wanted.second;
  if (result.trajectory.empty()) return failure(name + ": expected poses, found none");
  if (options.rules == PoseRules::kStrict) {
    result.dropped = drop_unusable(result.trajectory, name, result.notes);
  }
  return result;
}

}  // namespace aims
