// SPDX-License-Identifier: BSD-3-Clause
#include "live/clock_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

namespace aims {
namespace {

constexpr Duration kJump = kSecond;              ///< smaller ones are delays
constexpr Duration kSteady = kSecond / 5;        ///< stamps after a jump agree
constexpr Duration kLasting = kSecond;           ///< of a jump of all clocks
constexpr Duration kLastingAlone = 3 * kSecond;  ///< of one that others do not follow
constexpr Duration kPresent = kSecond;           ///< a topic without messages for longer is absent
/// For so long the others are waited for where some clocks have jumped: a program that was stopped
/// gets the backlog of one topic before the rest.
constexpr Duration kAwaited = 3 * kSecond;
/// A longer time without any message is one in which nothing was read.
constexpr Duration kReading = kSecond / 2;

}  // namespace

void ClockWatch::add(const std::string& topic, std::optional<Time> stamp, Time arrival) {
  if (newest_ && arrival < *newest_ - kJump && broken_.empty()) {
    broken_ = fmt::format(
        "times of arrival went back by {:.1f} s: the clock was set, or a "
        "recording is played again",
        to_seconds(*newest_ - arrival));
  }
  if (newest_) read_ += std::clamp<Duration>(arrival - *newest_, 0, kReading);
  newest_ = std::max(newest_.value_or(arrival), arrival);
  if (!stamp) return;
  const Duration offset = *stamp - arrival;
  const auto [place, added] = clocks_.try_emplace(topic);
  Clock& clock = place->second;
  clock.seen = arrival;
  clock.read = read_;
  if (added || *stamp != clock.stamp) clock.stays_since = arrival;
  clock.stamp = *stamp;
  if (added || std::abs(offset - clock.offset) <= kJump) {
    clock.offset = offset;
    clock.jumped_at.reset();
  } else if (!clock.jumped_at || std::abs(offset - clock.jumped_to) > kSteady) {
    clock.jumped_at = arrival;
    clock.jumped_to = offset;
  }
  judge();
}

bool ClockWatch::jumped(const Clock& clock, Duration lasting) const {
  return clock.jumped_at && clock.seen - *clock.jumped_at >= lasting;
}

bool ClockWatch::present(const Clock& clock) const { return *newest_ - clock.seen <= kPresent; }

void ClockWatch::judge() {
  std::vector<std::string> found;
  for (const auto& [topic, clock] : clocks_) {
    if (read_ - clock.read > kAwaited) continue;
    if (!jumped(clock, kLasting)) return;
    found.push_back(
        fmt::format("{} by {:.1f} s", topic, to_seconds(clock.jumped_to - clock.offset)));
  }
  if (!found.empty() && broken_.empty()) {
    broken_ = fmt::format("the clocks of the sensors jumped: {}", fmt::join(found, ", "));
  }
}

std::vector<std::string> ClockWatch::differing() const {
  std::vector<std::string> found;
  for (const auto& [topic, clock] : clocks_) {
    if (!present(clock)) continue;
    if (clock.seen - clock.stays_since >= kLastingAlone) {
      found.push_back(
          fmt::format("the stamps of {} stay at {:.1f} s", topic, to_seconds(clock.stamp)));
    } else if (jumped(clock, kLastingAlone)) {
      found.push_back(fmt::format("the clock of {} jumped by {:.1f} s", topic,
                                  to_seconds(clock.jumped_to - clock.offset)));
    }
  }
  return found;
}

}  // namespace aims
