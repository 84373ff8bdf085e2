// SPDX-License-Identifier: BSD-3-Clause
// Warnings of sensors, truth and recorder whose clocks differ.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "recordings/stream/recording_survey.hpp"
#include "recordings/stream/survey_latencies.hpp"

namespace aims {
namespace {

constexpr Duration kMaxOwnLatency = kSecond;  ///< of a sensor on the recorder's clock

/// "recorded 0.002 s after its stamps".
std::string recorded_text(Duration latency) {
  return fmt::format("recorded {:.3f} s {} its stamps", std::abs(to_seconds(latency)),
                     latency < 0 ? "before" : "after");
}

/// Which of two clocks the record times contradict.
std::string odd_clock(const std::string& one, Duration latency, const std::string& other,
                      Duration other_latency) {
  const bool odd = std::abs(latency) > kMaxOwnLatency;
  const bool other_odd = std::abs(other_latency) > kMaxOwnLatency;
  if (odd && other_odd) return "neither clock is the recorder's";
  if (!odd && !other_odd) return "their clocks differ";
  return fmt::format("the clock of {} is off", odd ? one : other);
}

/// Of clocks that differ by as much as GPS from UTC.
std::string_view gps_text(double ahead) {
  constexpr double kGps = 18.0, kTolerance = 0.5;  // [s]
  return std::abs(std::abs(ahead) - kGps) < kTolerance ? " (GPS is 18 s ahead of UTC)" : "";
}

}  // namespace

/// Warns of a truth whose clock is not that of the sensors.
void RecordingSurvey::warn_of_true_clock(const RecordingPlan& plan) {
  constexpr Duration kMost = kSecond;  // of a motion capture's computers and links
  const auto& truth = plan.latency[static_cast<std::size_t>(Role::kTruth)];
  const auto& imu = plan.latency[static_cast<std::size_t>(Role::kImu)];
  const Role reference = imu ? Role::kImu : Role::kLidar;
  const auto sensors = corrected_latency(reference, plan);
  if (!truth || !sensors || std::abs(*truth - *sensors) < kMost) return;
  const double ahead = to_seconds(*sensors - *truth);
  const std::string& other = imu ? topics_.imu : topics_.lidar;
  const auto lidar = corrected_latency(Role::kLidar, plan);
  const bool imu_alone = imu && lidar && std::abs(*truth - *lidar) < kMost;
  const std::string remedy =
      imu_alone ? fmt::format("the LiDAR agrees with the truth: set recording.imu_delay={:.3f}",
                              delay_of(config_, Role::kImu) - ahead)
                : fmt::format("score with aims score --time-offset={:.3f}", ahead);
  notes_.warn(
      "truth and sensors have different clocks",
      fmt::format("by the record times the truth is stamped {:.3f} s {} the sensors: scores "
                  "compare other instants, or none. {} is {}, {} is {}: {}{}; {}",
                  std::abs(ahead), ahead > 0.0 ? "ahead of" : "behind", topics_.truth,
                  recorded_text(*truth), other, recorded_text(*sensors),
                  odd_clock(topics_.truth, *truth, other, *sensors), gps_text(ahead), remedy));
}

/// By how much the stamps of other topics are behind those of the reference, by their record times.
std::map<Role, Duration> RecordingSurvey::behind(const RecordingPlan& plan,
                                                 const std::string& reference,
                                                 Duration latency) const {
  std::map<Role, Duration> result;
  for (std::size_t i = 0; i < kRoleCount; ++i) {
    const Role role = static_cast<Role>(i);
    const std::string& topic = topic_of(topics_, role);
    const auto own = latency_without_scan(role, plan);
    if (!own || role == Role::kTruth || topic == reference) continue;
    if (plan.leaps[i]) continue;  // no delay would correct it
    result[role] = *own + from_seconds(delay_of(config_, role)) - latency;
  }
  return result;
}

/// Warns of an IMU on another clock than all other topics, which agree; whether it does.
bool RecordingSurvey::warn_of_imu_clock(const std::map<Role, Duration>& behind,
                                        const std::string& reference) {
  std::set<std::string> others;
  for (const auto& [role, each] : behind) others.insert(topic_of(topics_, role));
  if (reference != topics_.imu || others.size() < 2) return false;
  Duration least = behind.begin()->second, most = least;
  for (const auto& [role, each] : behind) {
    least = std::min(least, each);
    most = std::max(most, each);
  }
  const Duration middle = least + (most - least) / 2;
  if (std::abs(middle) < kMaxLatencyDifference || most - least > kMaxLatencyDifference)
    return false;
  notes_.warn(
      fmt::format("clocks of {} and all other topics differ", reference),
      fmt::format("{}: stamps are {:.3f} s {} those of {}, which agree: set "
                  "recording.imu_delay={:.3f} if its clock differs",
                  reference, std::abs(to_seconds(middle)), middle > 0 ? "ahead of" : "behind",
                  fmt::join(others, ", "), delay_of(config_, Role::kImu) + to_seconds(middle)),
      WarnedSensor::kAny, WarningKind::kClocks);
  return true;
}

/// Warns of topics whose clock is not that of the reference.
void RecordingSurvey::warn_of_clocks(const RecordingPlan& plan, const std::string& reference,
                                     Duration latency) {
  const auto apart = behind(plan, reference, latency);
  if (warn_of_imu_clock(apart, reference)) return;
  for (const auto& [role, behind] : apart) {
    if (std::abs(behind) < kMaxLatencyDifference) continue;
    const std::string& topic = topic_of(topics_, role);
    notes_.warn(fmt::format("clocks of {} and {} differ", topic, reference),
                fmt::format("{}: stamps are {:.3f} s {} those of other topics: set "
                            "recording.{}_delay={:.3f} if their clocks differ",
                            topic, std::abs(to_seconds(behind)), behind > 0 ? "behind" : "ahead of",
                            role == Role::kLidar ? "lidar" : "leg",
                            delay_of(config_, role) - to_seconds(behind)),
                WarnedSensor::kAny, WarningKind::kClocks);
  }
}

}  // namespace aims
