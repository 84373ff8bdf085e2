// SPDX-License-Identifier: BSD-3-Clause
// How latencies change: clocks that leap, are set back, or run at another rate.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <ranges>
#include <utility>

#include "core/median.hpp"
#include "recordings/stream/latency_changes.hpp"
#include "recordings/stream/recording_survey.hpp"
#include "recordings/stream/survey_latencies.hpp"

namespace aims {
namespace {

constexpr Duration kMaxBetween = kSecond;  ///< of the samples before and after a step
constexpr std::size_t kFirst = 20;         ///< messages whose latency is that before a step

/// Whether nearly all are much the same.
bool is_steady(const std::vector<Duration>& latencies) {
  const Duration usual = upper_median(latencies).value_or(0);
  const auto odd = std::ranges::count_if(latencies, [usual](Duration latency) {
    return std::abs(latency - usual) > kMaxLatencyDifference / 2;
  });
  return static_cast<std::size_t>(odd) * 20 < latencies.size();
}

}  // namespace

/// By how much latencies grow; nothing of few messages.
std::optional<RecordingSurvey::LatencyGrowth> RecordingSurvey::growth_of(const Seen& each) {
  constexpr std::size_t kLeast = 10;  // messages of each third
  const std::size_t third = each.stamps.size() / 3;
  if (each.unstamped || third < kLeast || stamps_stand(each.stamps)) return std::nullopt;
  const SeriesGrowth latency = aims::growth_of(each.latencies);
  const LatencyGrowth found = {latency.grown, aims::growth_of(each.stamps).grown, latency.is_even};
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
  const auto found = aims::leap_of(each.latencies, {.margin = kLeast,
                                                    .least = kMaxLatencyDifference,
                                                    .least_sudden = kMaxLatencyDifference,
                                                    .near = kMaxLatencyDifference / 2});
  if (!found) return std::nullopt;
  return Leap{found->at, each.stamps[found->at] + each.latencies[found->at], -found->step};
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

}  // namespace aims
