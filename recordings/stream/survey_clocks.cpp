// SPDX-License-Identifier: BSD-3-Clause
// What stamps and record times say of the clocks, and of samples that are sent again.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <ranges>
#include <set>
#include <span>
#include <utility>

#include "recordings/clouds/scan_period.hpp"
#include "recordings/clouds/stamp_steps.hpp"
#include "recordings/median.hpp"
#include "recordings/stream/record_clock.hpp"
#include "recordings/stream/recording_survey.hpp"
#include "recordings/stream/series_change.hpp"

namespace aims {
namespace {

/// Larger differences mean that recorder and sensors use different clocks.
constexpr Duration kMaxClockDifference = 5 * kSecond;
/// Between the latencies of sensors on one clock.
constexpr Duration kMaxLatencyDifference = kSecond / 4;
/// A step back of stamps that is no exchange of neighbours.
constexpr Duration kMaxDisorder = kSecond / 5;
constexpr Duration kLongestStep = 100'000 * kSecond;  ///< a day, as of a wrong date
constexpr Duration kMaxBetween = kSecond;             ///< of the samples before and after a step
constexpr Duration kMaxOwnLatency = kSecond;          ///< of a sensor on the recorder's clock
constexpr std::size_t kFirst = 20;  ///< messages whose latency is that before a step

bool stamps_stand(const std::vector<Time>& stamps) {
  std::size_t steps = 0;
  for (std::size_t i = 1; i < stamps.size(); ++i) steps += stamps[i] != stamps[i - 1] ? 1 : 0;
  return hardly_advance(steps, stamps.size());
}

/// The latency that a tenth of the messages do not reach: others were delayed.
Duration early_latency(std::vector<Duration> latencies) {
  const auto at = latencies.begin() + static_cast<std::ptrdiff_t>(latencies.size() / 10);
  std::ranges::nth_element(latencies, at);
  return *at;
}

/// Whether nearly all are much the same.
bool is_steady(const std::vector<Duration>& latencies) {
  const Duration usual = upper_median(latencies).value_or(0);
  const auto odd = std::ranges::count_if(latencies, [usual](Duration latency) {
    return std::abs(latency - usual) > kMaxLatencyDifference / 2;
  });
  return static_cast<std::size_t>(odd) * 20 < latencies.size();
}

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

/// By how much latencies grow; nothing of few messages.
std::optional<RecordingSurvey::LatencyGrowth> RecordingSurvey::growth_of(const Seen& each) {
  constexpr std::size_t kLeast = 10;  // messages of each third
  const std::size_t third = each.stamps.size() / 3;
  if (each.unstamped || third < kLeast || stamps_stand(each.stamps)) return std::nullopt;
  const SeriesGrowth latency(medians_of_thirds(each.latencies));
  const auto stamps = medians_of_thirds(each.stamps);
  const LatencyGrowth found = {latency.grown, stamps[2] - stamps[0], latency.is_even()};
  return found.span > 0 && found.rate() > 0.0 ? std::optional(found) : std::nullopt;
}

/// Of the topic with the longest part seen, since of dense ones it is short; the others agree.
std::optional<double> RecordingSurvey::record_rate() const {
  std::map<std::string, double> rates;  // by topic
  LatencyGrowth longest;
  for (std::size_t i = 0; i < kRoleCount; ++i) {
    const std::string& topic = topic_of(topics_, static_cast<Role>(i));
    if (topic.empty() || seen_[i].stamps.empty()) continue;
    const auto growth = growth_of(seen_[i]);
    if (!growth) return std::nullopt;
    rates[topic] = growth->rate();
    if (growth->span > longest.span) longest = *growth;
  }
  if (rates.size() < 2 || std::abs(longest.growth) < kMaxLatencyDifference || !longest.even) {
    return std::nullopt;
  }
  const double best = longest.rate();
  const bool agree = std::ranges::all_of(rates | std::views::values, [best](double each) {
    return 4.0 * std::abs(each - best) < std::abs(best - 1.0);
  });
  return agree ? std::optional(best) : std::nullopt;
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

/// Where the recorder's clock was set back: stamps go backwards in the order of the recording, and
/// from some stamp on latencies are shorter than those of the earliest stamps.
std::optional<RecordingSurvey::ClockStep> RecordingSurvey::clock_step_of(const Seen& each) {
  std::vector<std::pair<Time, Duration>> by_stamp;
  int backwards = 0;
  bool swapped = false;
  for (std::size_t i = 0; i < each.stamps.size(); ++i) {
    by_stamp.emplace_back(each.stamps[i], each.latencies[i]);
    if (i == 0 || each.stamps[i] >= each.stamps[i - 1] - kMaxDisorder) continue;
    // A step of more than the recording puts all that follows it in front, in one piece.
    const Duration apart = each.stamps.front() - each.stamps.back();
    swapped = ++backwards == 1 && apart > 0 && apart < kMaxBetween;
  }
  if (backwards < 2 && !swapped) return std::nullopt;
  std::ranges::stable_sort(by_stamp, {}, &std::pair<Time, Duration>::first);
  std::vector<Duration> before, after;
  for (std::size_t i = 0; i < std::min(by_stamp.size(), kFirst); ++i) {
    before.push_back(by_stamp[i].second);
  }
  const Duration usual = early_latency(before);
  std::optional<Time> stamp;
  for (const auto& [at, latency] : by_stamp) {
    if (latency >= usual - kMaxDisorder / 2) continue;
    if (!stamp) stamp = at;
    after.push_back(latency);
  }
  if (!stamp) return std::nullopt;
  return ClockStep{*stamp, usual - early_latency(std::move(after))};
}

/// Record time minus stamp of messages without delay, before the recorder's clock was set back.
Duration RecordingSurvey::latency_of(const Seen& each, const std::optional<ClockStep>& step) {
  if (!step) return early_latency(each.latencies);
  std::vector<Duration> before;
  for (std::size_t i = 0; i < each.stamps.size(); ++i) {
    // What was on its way at the step is recorded after it.
    if (each.stamps[i] < step->stamp - kMaxDisorder) before.push_back(each.latencies[i]);
  }
  return before.empty() ? early_latency(each.latencies) + step->back
                        : early_latency(std::move(before));
}

/// Where latencies change once for all: stamps or record times leap there.
std::optional<RecordingSurvey::Leap> RecordingSurvey::leap_of(const Seen& each) {
  constexpr std::size_t kLeast = 5;  // messages before and behind it
  const auto& latencies = each.latencies;
  if (latencies.size() < 2 * kLeast) return std::nullopt;
  const auto half = [](Duration /*step*/) { return kMaxLatencyDifference / 2; };
  const auto found = largest_leap(latencies, kLeast, kMaxLatencyDifference, half);
  const bool lasts = found && 10 * found->strays < latencies.size();
  if (!lasts || std::abs(found->step()) < kMaxLatencyDifference) return std::nullopt;
  return Leap{found->at, each.stamps[found->at] + latencies[found->at], -found->step()};
}

/// Whether another topic goes on there as before: then it is no leap of the recorder's clock.
bool RecordingSurvey::leaps_alone(Role role, const Leap& leap) const {
  const std::string& topic = topic_of(topics_, role);
  for (std::size_t i = 0; i < kRoleCount; ++i) {
    const Seen& other = seen_[i];
    const std::string& name = topic_of(topics_, static_cast<Role>(i));
    if (name == topic || name.empty() || other.unstamped || stamps_stand(other.stamps)) continue;
    bool before = false, behind = false;
    for (std::size_t k = 0; k < other.stamps.size(); ++k) {
      const Duration after = other.stamps[k] + other.latencies[k] - leap.recorded;
      before = before || after < 0;
      behind = behind || after > kMaxLatencyDifference;
    }
    if (before && behind && is_steady(other.latencies)) return true;
  }
  return false;
}

/// The leap of the stamps of a topic, of which it warns.
std::optional<RecordingSurvey::Leap> RecordingSurvey::decide_leap(Role role, RecordingPlan& plan) {
  const auto leap = leap_of(seen(role));
  if (!leap || seen(role).unstamped || !leaps_alone(role, *leap)) return std::nullopt;
  const std::string& topic = topic_of(topics_, role);
  const Time first = seen(role).stamps.front() + seen(role).latencies.front();
  plan.leaps[static_cast<std::size_t>(role)] = true;
  notes_.warn(fmt::format("stamps of {} leap", topic),
              fmt::format("{}: stamps leap by {:.3f} s, {:.1f} s after its first message, while "
                          "record times and other topics do not: what is before and behind it "
                          "does not fit together",
                          topic, to_seconds(leap->stamps), to_seconds(leap->recorded - first)));
  return leap;
}

/// By how much longer the first message of a burst waits to be recorded than the last one.
Duration RecordingSurvey::burst_of(Role role) const {
  std::vector<Duration> delays = seen(role).delays;
  if (delays.size() < kFirst) return 0;
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
                  fmt::join(others, ", "), delay_of(config_, Role::kImu) + to_seconds(middle)));
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
                            delay_of(config_, role) - to_seconds(behind)));
  }
}

}  // namespace aims
