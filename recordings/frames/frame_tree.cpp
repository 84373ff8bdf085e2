// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/frames/frame_tree.hpp"

#include <algorithm>
#include <deque>

#include "recordings/messages/message_values.hpp"

namespace aims {
namespace {

constexpr std::size_t kMaxPairs = 1000;
constexpr double kSameDistance = 0.01;  ///< [m]
constexpr double kSameAngle = 0.02;     ///< [rad]

bool differ(const Pose& a, const Pose& b) {
  return (a.translation - b.translation).norm() > kSameDistance ||
         a.rotation.angularDistance(b.rotation) > kSameAngle;
}

}  // namespace

std::string FrameTree::plain(std::string_view frame) {
  if (frame.starts_with('/')) frame.remove_prefix(1);
  return std::string(frame);
}

bool FrameTree::add(std::string_view parent, std::string_view child, const Pose& T_parent_child) {
  const std::string from = plain(parent);
  const std::string to = plain(child);
  const double norm = T_parent_child.rotation.norm();
  if (from == to || from.empty() || to.empty() || pairs_ >= kMaxPairs) return false;
  if (!T_parent_child.translation.allFinite() || !(norm > 0.5) || !(norm < 2.0)) return false;
  Pose pose = T_parent_child;
  if (is_off_unit(pose.rotation)) pose.rotation.normalize();
  const std::pair<std::string, std::string> pair(from, to);
  if (const auto before = neighbours_.find(from);
      before != neighbours_.end() && before->second.contains(to)) {
    if (differ(before->second.at(to), pose))
      others_.insert_or_assign(pair, Other{pose, {from, to}});
    return true;
  }
  // A second chain between two frames.
  if (const auto joined = transform(from, to); joined && differ(*joined, pose)) {
    others_.insert_or_assign(pair, Other{*joined, chain(from, to)});
  }
  neighbours_[from][to] = pose;
  neighbours_[to][from] = pose.inverse();
  ++pairs_;
  return true;
}

void FrameTree::add(const MessageView& message, EventCounts& counts) {
  for (const FrameTransform& each : transforms_in(message)) {
    if (!add(each.parent, each.child, each.T_parent_child)) ++counts["tf_unusable"];
  }
}

std::vector<std::string> FrameTree::chain(std::string_view from, std::string_view to) const {
  const std::string start = plain(from);
  const std::string goal = plain(to);
  if (start == goal) return {start};
  std::map<std::string, std::string> came_from = {{start, start}};
  std::deque<std::string> open = {start};
  while (!open.empty() && !came_from.contains(goal)) {
    const std::string here = open.front();
    open.pop_front();
    const auto found = neighbours_.find(here);
    if (found == neighbours_.end()) continue;
    for (const auto& [there, pose] : found->second) {
      if (came_from.emplace(there, here).second) open.push_back(there);
    }
  }
  if (!came_from.contains(goal)) return {};
  std::vector<std::string> frames = {goal};
  while (frames.back() != start) frames.push_back(came_from[frames.back()]);
  std::reverse(frames.begin(), frames.end());
  return frames;
}

std::optional<Pose> FrameTree::transform(std::string_view from, std::string_view to) const {
  const std::vector<std::string> frames = chain(from, to);
  if (frames.empty()) return std::nullopt;
  std::optional<Pose> total;
  for (std::size_t i = 1; i < frames.size(); ++i) {
    const Pose& step = neighbours_.at(frames[i - 1]).at(frames[i]);
    total = total ? *total * step : step;
  }
  return total.value_or(Pose{});
}

std::optional<FrameTree::Contradiction> FrameTree::contradiction(std::string_view from,
                                                                 std::string_view to) const {
  const std::vector<std::string> frames = chain(from, to);
  const auto joins = [&frames](const std::string& frame) {
    return std::ranges::find(frames, frame) != frames.end();
  };
  for (const auto& [pair, other] : others_) {
    if (std::ranges::count_if(other.frames, joins) < 2) continue;
    const Pose used = *transform(pair.first, pair.second);
    const double distance = (used.translation - other.pose.translation).norm();
    return Contradiction{pair.first, pair.second, distance,
                         used.rotation.angularDistance(other.pose.rotation)};
  }
  return std::nullopt;
}

}  // namespace aims
