// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/legs/foot_differences.hpp"

#include <algorithm>

namespace aims {
namespace {

/// So long before and after it a foot stands. The load of a real foot ends 35 ms after lift-off.
constexpr Duration kSettled = 40 * kMillisecond;
constexpr Duration kMaxStep = 60 * kMillisecond;  ///< between instants
constexpr std::size_t kMost = 1000;               ///< instants

}  // namespace

std::vector<FootRise> FootDifferences::add(const LegOdometrySample& legs) {
  Instant now = {legs.stamp, legs.angular_velocity, {}, legs.contact};
  for (int leg = 0; leg < kLegCount; ++leg) {
    now.feet[static_cast<std::size_t>(leg)] =
        foot_in_base(leg, Eigen::Vector3d(&legs.joint_position[3 * leg]), geometry_);
  }
  const Duration step = last_.empty() ? 0 : now.stamp - last_.back().stamp;
  if (step <= 0 || step > kMaxStep || last_.size() == kMost) last_.clear();
  last_.push_back(now);
  // The last instant that is long enough ago, and those that are as long before it.
  const auto is_recent = [&](const Instant& each) { return now.stamp - each.stamp < kSettled; };
  const auto after = std::ranges::find_if(last_, is_recent);
  if (after - last_.begin() < 2) return {};
  const Instant &at = *(after - 1), &before = *(after - 2);
  if (at.stamp - last_.front().stamp < kSettled) return {};
  std::vector<FootRise> rises;
  for (std::size_t leg = 0; leg < legs.contact.size(); ++leg) {
    const auto stands = [leg](const Instant& each) { return each.contact[leg]; };
    if (!std::ranges::all_of(last_, stands)) continue;
    const Eigen::Vector3d velocity =
        (after->feet[leg] - before.feet[leg]) / to_seconds(after->stamp - before.stamp);
    rises.push_back({static_cast<int>(leg), -(velocity + at.turning.cross(at.feet[leg])).z()});
  }
  while (at.stamp - last_[1].stamp >= kSettled) last_.pop_front();
  return rises;
}

}  // namespace aims
