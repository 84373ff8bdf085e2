// SPDX-License-Identifier: BSD-3-Clause
// What stamps and record times say of the clocks, and of samples that are sent again; what that
// means for the arrivals.
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <ranges>
#include <span>
#include <utility>

#include "recordings/clouds/scan_period.hpp"
#include "recordings/stream/record_clock.hpp"
#include "recordings/stream/recording_survey.hpp"
#include "recordings/stream/survey_latencies.hpp"

namespace aims {
namespace {

/// Larger differences mean that recorder and sensors use different clocks.
constexpr Duration kMaxClockDifference = 5 * kSecond;
constexpr Duration kLongestStep = 100'000 * kSecond;  ///< a day, as of a wrong date
constexpr std::size_t kFewestOfBurst = 20;            ///< messages

/// Where configured delays differ by more, arrivals move with the stamps: estimators sort what
/// arrives within 50 ms, and would drop what is later.
constexpr double kSortedDelay = 0.025;  ///< [s]
/// Beyond it the sensors have different clocks, and arrive when they do.
constexpr double kMaxDelay = 2.0;  ///< [s]

}  // namespace

double delay_of(const RecordingConfig& config, Role role) {
  if (role == Role::kTruth) return 0.0;
  if (role == Role::kLidar) return config.lidar_delay;
  return role == Role::kImu ? config.imu_delay : config.leg_delay;
}

/// Record time minus stamp of a role that measures, without the time in which a scan is taken.
std::optional<Duration> RecordingSurvey::latency_without_scan(Role role,
                                                              const RecordingPlan& plan) {
  auto latency = plan.latency[static_cast<std::size_t>(role)];
  // A cloud with the stamp of its start is complete, and sent, a period later.
  if (latency && role == Role::kLidar && plan.cloud.stamp == CloudStamp::kStart) {
    *latency -= plan.cloud.period;
  }
  return latency;
}

/// Record time minus the stamp that the configured delay corrects.
std::optional<Duration> RecordingSurvey::corrected_latency(Role role,
                                                           const RecordingPlan& plan) const {
  const auto& latency = plan.latency[static_cast<std::size_t>(role)];
  return latency ? std::optional(*latency + from_seconds(delay_of(config_, role))) : std::nullopt;
}

/// Arrival minus corrected stamp by role [s], where the record times show that clocks differ: then
/// delays correct clocks, and messages arrive at their corrected stamps, also where arrivals are
/// shifted already. Roles that do not tell have the largest.
std::optional<std::array<double, kRoleCount>> RecordingSurvey::corrected_latencies(
    const RecordingPlan& plan) const {
  std::map<std::size_t, double> corrected;
  std::vector<Duration> latencies;
  for (std::size_t i = 0; i < kRoleCount; ++i) {
    const Role role = static_cast<Role>(i);
    const auto latency = latency_without_scan(role, plan);
    if (!latency || role == Role::kTruth || plan.leaps[i]) continue;
    latencies.push_back(*latency);
    corrected[i] = to_seconds(*latency + plan.arrival_shift) + delay_of(config_, role);
  }
  if (latencies.empty()) return std::nullopt;
  const auto [least, most] = std::ranges::minmax(latencies);
  if (most - least < kMaxLatencyDifference) return std::nullopt;
  std::array<double, kRoleCount> all{};
  all.fill(std::ranges::max(corrected | std::views::values));
  for (const auto& [role, latency] : corrected) all[role] = latency;
  return all;
}

/// Messages with smaller delays wait for those with the largest, which then arrive earlier.
void RecordingSurvey::decide_waits(RecordingPlan& plan) const {
  std::array<double, kRoleCount> delays{};
  double smallest = 0.0, largest = 0.0;
  bool any = false;
  // Where arrivals are shifted, they are so by the delay of the reference too.
  const Role reference =
      plan.latency[static_cast<std::size_t>(Role::kImu)] ? Role::kImu : Role::kLidar;
  const double shifted = plan.arrival_shift != 0 ? delay_of(config_, reference) : 0.0;
  for (std::size_t i = 0; i < kRoleCount; ++i) {
    const Role role = static_cast<Role>(i);
    if (role == Role::kTruth || topic_of(topics_, role).empty()) continue;
    if (plan.stamped_by_record[i]) return;  // a later record time would be a later stamp
    delays[i] = delay_of(config_, role) - shifted;
    smallest = any ? std::min(smallest, delays[i]) : delays[i];
    largest = any ? std::max(largest, delays[i]) : delays[i];
    any = true;
  }
  const auto corrected = largest > smallest ? corrected_latencies(plan) : std::nullopt;
  // Joints wait for contacts that arrive later, and all others with them.
  const double late = to_seconds(contact_lateness(plan));
  if (corrected) {
    delays = *corrected;
    smallest = std::ranges::min(delays);
    largest = std::ranges::max(delays);
  } else if (late > kSortedDelay) {
    delays[static_cast<std::size_t>(Role::kContacts)] += late;
    largest = std::max(largest, delays[static_cast<std::size_t>(Role::kContacts)]);
  }
  if (largest - smallest <= kSortedDelay || largest - smallest >= kMaxDelay) return;
  for (std::size_t i = 0; i < kRoleCount; ++i) {
    plan.wait[i] = std::max<Duration>(0, from_seconds(largest - delays[i]));
  }
  plan.arrival_shift -= from_seconds(largest);
}

/// By how much longer the first message of a burst waits to be recorded than the last one.
Duration RecordingSurvey::burst_of(Role role) const {
  std::vector<Duration> delays = seen(role).delays;
  if (delays.size() < kFewestOfBurst) return 0;
  std::ranges::sort(delays);
  const std::size_t few = delays.size() / 20;
  const Duration burst = delays[delays.size() - 1 - few] - delays[few];
  return burst < kSecond ? burst : 0;
}

/// By how much contacts arrive later than joints of the same stamp; negative: earlier.
Duration RecordingSurvey::contact_lateness(const RecordingPlan& plan) const {
  const auto& joints = plan.latency[static_cast<std::size_t>(Role::kJoints)];
  const auto& contacts = plan.latency[static_cast<std::size_t>(Role::kContacts)];
  const bool stamped = !seen(Role::kJoints).unstamped && !seen(Role::kContacts).unstamped;
  if (!joints || !contacts || !stamped || topics_.joint_states == topics_.contacts) return 0;
  const Duration late = *contacts - *joints;
  return std::abs(late) < kMaxLatencyDifference ? late : 0;
}

/// Samples that are sent again under new stamps count once.
void RecordingSurvey::decide_repeats(RecordingPlan& plan) {
  for (const auto& [topic, finder] : repeats_) {
    const auto period = finder.period();
    if (!period) continue;
    plan.repeat_period[topic] = *period;
    notes_.push_back(fmt::format(
        "{}: each sample is sent {:.1f} times, and new every {:.1f} ms: "
        "repetitions are left out",
        topic, static_cast<double>(finder.messages()) / static_cast<double>(finder.samples()),
        1e3 * to_seconds(*period)));
    for (std::size_t i = 0; i < kRoleCount; ++i) {
      if (topic_of(topics_, static_cast<Role>(i)) == topic) keep_new(seen_[i]);
    }
  }
}

void RecordingSurvey::keep(Seen& each, const std::vector<bool>& kept) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    if (!kept[i]) continue;
    each.stamps[count] = each.stamps[i];
    each.latencies[count] = each.latencies[i];
    each.is_new[count++] = each.is_new[i];
  }
  each.stamps.resize(count);
  each.latencies.resize(count);
  each.is_new.resize(count);
}

void RecordingSurvey::keep_new(Seen& each) { keep(each, std::vector<bool>(each.is_new)); }

/// Messages whose record time or stamp was not set yet say nothing of the clocks.
void RecordingSurvey::leave_out_unset() {
  for (Seen& each : seen_) {
    Time least = std::numeric_limits<Time>::max();  // of the stamps that are not 0
    for (const Time stamp : each.stamps) least = stamp != 0 ? std::min(least, stamp) : least;
    const bool zeros_are_unset =
        least > kMaxClockDifference && least < std::numeric_limits<Time>::max();
    std::vector<bool> kept;
    for (std::size_t i = 0; i < each.stamps.size(); ++i) {
      const Time stamp = each.stamps[i], recorded = stamp + each.latencies[i];
      const bool unset = first_set_ && recorded < kSetRecordTime && stamp > kSetRecordTime;
      kept.push_back(!unset && !(zeros_are_unset && stamp == 0));
    }
    if (std::ranges::find(kept, true) != kept.end()) keep(each, kept);
  }
}

/// Of a topic without messages.
void RecordingSurvey::note_silence(Role role, const std::string& topic) {
  if (role == Role::kTruth) return;
  if (role != Role::kImu || !topic.ends_with("/imu")) {
    return notes_.push_back(fmt::format("{}: no message", topic));
  }
  notes_.warn("no message of the IMU",
              fmt::format("{}: no message; if gyro and accelerometer are two topics, their stamps "
                          "do not overlap",
                          topic));
}

/// Of a topic whose stamps do not serve.
void RecordingSurvey::note_record_times(Role role, const std::string& topic) {
  const std::vector<Time>& stamps = seen(role).stamps;
  const bool zero = std::ranges::count(stamps, 0) == std::ssize(stamps);
  std::vector<Time> recorded = stamps;
  for (std::size_t i = 0; i < recorded.size(); ++i) recorded[i] += seen(role).latencies[i];
  const bool batched = batched_rate(std::move(recorded)).has_value();
  const std::string what =
      zero ? "stamps are all zero, "
           : "stamps do not advance from message to message (a clock that stands still, or whole "
             "seconds): ";
  const std::string text = fmt::format("{}: {}record times are used", topic, what);
  notes_.stamp_faults[topic] = StampFault::kUnusable;
  if (zero && !batched) return notes_.push_back(text);
  notes_.warn(fmt::format("stamps of {} do not advance", topic),
              text + (batched ? ", which come in batches of no steady rate: times within a batch "
                                "are not known"
                              : ""));
}

/// Clocks: stamps that were never set, and sensors with different clocks.
void RecordingSurvey::decide_stamps(RecordingPlan& plan) {
  leave_out_unset();
  // Of the topic with the most messages, whose stamps tell the step best.
  const auto measured = std::span(seen_).first(static_cast<std::size_t>(Role::kTruth));
  const auto densest =
      std::ranges::max_element(measured, {}, [](const Seen& each) { return each.stamps.size(); });
  const auto step = clock_step_of(*densest);
  if (step) {
    plan.max_early = std::min(plan.max_early, step->back / 2);
    plan.max_hold += std::min(step->back, kLongestStep);
  }
  for (std::size_t i = 0; i < kRoleCount; ++i) {
    const Role role = static_cast<Role>(i);
    const std::string& topic = topic_of(topics_, role);
    if (topic.empty()) continue;
    if (seen_[i].stamps.empty()) {
      note_silence(role, topic);
    } else if (stamps_stand(seen_[i].stamps)) {
      plan.stamped_by_record[i] = true;
      note_record_times(role, topic);
    } else if (const auto leap = step ? std::nullopt : decide_leap(role, plan)) {
      const auto& all = seen_[i].latencies;
      plan.latency[i] =
          early_latency({all.begin(), all.begin() + static_cast<std::ptrdiff_t>(leap->at)});
    } else {
      plan.latency[i] = latency_of(seen_[i], step);
    }
  }
  warn_of_true_clock(plan);
  const auto& imu = plan.latency[static_cast<std::size_t>(Role::kImu)];
  const auto& lidar = plan.latency[static_cast<std::size_t>(Role::kLidar)];
  const std::optional<Duration> first = imu ? imu : lidar;
  if (!first) return;
  const Duration latency =
      *first + from_seconds(delay_of(config_, imu ? Role::kImu : Role::kLidar));
  warn_of_clocks(plan, imu ? topics_.imu : topics_.lidar, latency);
  if (std::abs(latency) < kMaxClockDifference) return;
  plan.arrival_shift = -latency;
  notes_.push_back(
      fmt::format("arrivals are {:.3f} s {} the sensors' stamps: they are shifted by it",
                  std::abs(to_seconds(latency)), latency > 0 ? "ahead of" : "behind"));
}

/// An IMU alone is no motion: without legs the estimate begins before the first scan, while the
/// robot stands as it would at the start.
void RecordingSurvey::decide_begin(RecordingPlan& plan) {
  constexpr Duration kLongAlone = 5 * kSecond, kStanding = 3 * kSecond;
  const Seen& imu = seen(Role::kImu);
  const Seen& lidar = seen(Role::kLidar);
  if (plan.setup.has_legs || imu.stamps.empty() || lidar.stamps.empty()) return;
  const Time first = lidar.stamps.front() + lidar.latencies.front();
  const Duration alone = first - (imu.stamps.front() + imu.latencies.front());
  if (alone < kLongAlone) return;
  plan.begin = first - kStanding;
  notes_.push_back(
      fmt::format("scans begin {:.1f} s after the IMU: the estimate begins {:.0f} s "
                  "before the first one",
                  to_seconds(alone), to_seconds(kStanding)));
}

}  // namespace aims
