// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/stream/stamp_watch.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <string>

#include "recordings/stream/stream_warnings.hpp"

namespace aims {

std::optional<Duration> StampWatch::leap_of(Role role, Time stamp, Duration late, Time recorded) {
  if (role != Role::kImu) {
    return leaps_[static_cast<std::size_t>(role)].add(stamp, late, recorded, steady_imu_);
  }
  steady_imu_.add(late, recorded);
  return std::nullopt;
}

void StampWatch::finish(RecordingPlan& plan, EventCounts& counts) const {
  warn_of_leaps(plan, counts);
  warn_of_imu_leap(plan, counts);
  warn_of_rates(plan);
}

/// Warns of stamps of one topic that leapt.
void StampWatch::warn_of_leaps(RecordingPlan& plan, EventCounts& counts) const {
  for (std::size_t i = 0; i < kRoleCount; ++i) {
    const Role role = static_cast<Role>(i);
    if (leaps_[i].count() == 0) continue;
    counts[fmt::format("{}_stamps_leap", name_of(role))] = leaps_[i].count();
    if (steady_imu_
            .was_always_steady()) {  // the first one that leapt was no matter of the recorder
      counts.erase("recorded_before_their_stamp");
      counts.erase("recorded_long_after_their_stamp");
    }
    plan.setup.warnings.push_back(
        warning_of_leaps(role, topic_of(plan.setup.topics, role), leaps_[i], plan.start));
  }
}

/// Warns of stamps of the IMU that leap while those of the LiDAR go on; the recorder is not to
/// blame.
void StampWatch::warn_of_imu_leap(RecordingPlan& plan, EventCounts& counts) const {
  constexpr auto kImu = static_cast<std::size_t>(Role::kImu);
  constexpr auto kLidar = static_cast<std::size_t>(Role::kLidar);
  if (steady_imu_.was_always_steady() || leaps_[kLidar].count() > 0) return;
  const auto step = trends_[kImu].step(trends_[kLidar]);
  if (!step || std::abs(*step) < SteadyTopic::kUsual) return;
  counts.erase("recorded_before_their_stamp");
  counts.erase("recorded_long_after_their_stamp");
  const TopicsConfig& topics = plan.setup.topics;
  plan.setup.warnings.push_back(warning_of_imu_leap(topics.imu, topics.lidar, -*step));
}

/// Warns of clocks that run at different rates.
void StampWatch::warn_of_rates(RecordingPlan& plan) const {
  constexpr auto kImu = static_cast<std::size_t>(Role::kImu);
  const std::string& imu = plan.setup.topics.imu;
  for (const Role role : {Role::kLidar, Role::kLegs, Role::kJoints}) {
    const auto index = static_cast<std::size_t>(role);
    const auto growth = trends_[kImu].growth(trends_[index]);
    const std::string& topic = topic_of(plan.setup.topics, role);
    if (!growth || topic.empty() || topic == imu) continue;
    plan.setup.warnings.push_back(warning_of_rates(imu, topic, *growth));
    return;
  }
}

}  // namespace aims
