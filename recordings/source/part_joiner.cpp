// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/source/part_joiner.hpp"

#include <algorithm>
#include <utility>

#include "core/median.hpp"

namespace aims {
namespace {

constexpr Duration kBack = kSecond;                  ///< of a clock that was set back
constexpr Duration kLongestWait = kSecond * 3 / 10;  ///< for a part whose messages come in bursts
constexpr std::size_t kMostWaiting = 1000;           ///< samples of a part
constexpr int kManyMissed = 3;  ///< sets without a new sample: it is not awaited

}  // namespace

void PartJoiner::add(std::size_t index, LegPartSample sample) {
  Part& part = parts_[index];
  if (part.added - sample.time > kBack) *this = PartJoiner(parts_.size(), on_change_);
  if (part.added > 0 && sample.time <= part.added) return;
  part.added = sample.time;
  newest_ = std::max(newest_, sample.time);
  part.waiting.push_back(std::move(sample));
  if (part.waiting.size() > kMostWaiting) part.waiting.pop_front();
}

/// Whether the part should have sent a sample by then.
bool PartJoiner::is_late(const Part& part, Time time) const {
  return part.last && part.period > 0 && time > part.last->time + part.period + part.period / 2;
}

/// Whether the part has sent none for several of its periods.
bool PartJoiner::is_silent(const Part& part, Time time) {
  constexpr Duration kPeriods = 3;
  return part.period > 0 && time - part.last->time > kPeriods * part.period;
}

/// Whether a sample of the part from before that time may still come.
bool PartJoiner::is_awaited(const Part& part, Time time) const {
  if (!part.waiting.empty()) return false;
  if (!part.last) return true;
  if (on_change_) return false;
  if (time <= part.last->time + part.period / 2) return false;
  return newest_ - part.last->time <= std::max(kLongestWait, 3 * part.period);
}

/// The part with the earliest sample, unless an earlier one may still come.
std::optional<std::size_t> PartJoiner::earliest() const {
  std::optional<std::size_t> first;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    if (parts_[i].waiting.empty()) continue;
    if (!first || parts_[i].waiting.front().time < parts_[*first].waiting.front().time) first = i;
  }
  if (!first) return first;
  const Time time = parts_[*first].waiting.front().time;
  const bool wait =
      std::ranges::any_of(parts_, [&](const Part& each) { return is_awaited(each, time); });
  return wait ? std::nullopt : first;
}

void PartJoiner::take(Part& part) {
  LegPartSample sample = std::move(part.waiting.front());
  part.waiting.pop_front();
  if (part.last && !on_change_) {
    part.steps[part.count++ % part.steps.size()] = sample.time - part.last->time;
    const auto known = std::min(part.count, part.steps.size());
    part.period = *upper_median(
        std::vector<Duration>(part.steps.begin(), part.steps.begin() + static_cast<long>(known)));
  }
  part.last = std::move(sample);
  part.is_new = true;
  if (!begun_) begun_ = part.last->time;
}

/// Whether all parts have something new but those that have been silent for a while; on change,
/// whether all have anything.
bool PartJoiner::is_whole(Time time) const {
  return std::ranges::all_of(parts_, [&](const Part& each) {
    return each.is_new || (on_change_ && each.last) ||
           (each.missed >= kManyMissed && is_late(each, time));
  });
}

/// Whether the set that has begun is over, and what it lacks is late.
bool PartJoiner::lacks(Time time) const {
  return begun_ && std::ranges::all_of(parts_, [&](const Part& each) {
           return each.is_new ||
                  (is_late(each, time) && time > *begun_ + each.period - each.period / 4);
         });
}

JoinedParts PartJoiner::give() {
  JoinedParts set;
  Time newest = 0;
  for (const Part& each : parts_) {
    if (each.is_new) newest = std::max(newest, each.last->time);
  }
  Duration before = 0;  // of the newest one, summed up
  std::int64_t count = 0;
  for (Part& each : parts_) {
    if (each.is_new && !is_silent(each, newest)) {
      before += newest - each.last->time;
      ++count;
    }
    each.missed = each.is_new ? 0 : each.missed + 1;
    each.is_new = false;
    set.samples.push_back(&*each.last);
  }
  begun_.reset();
  set.time = std::max(newest - before / std::max<std::int64_t>(count, 1), given_ + 1);
  given_ = set.time;
  for (const Part& each : parts_) set.silent.push_back(is_silent(each, set.time));
  return set;
}

std::optional<JoinedParts> PartJoiner::next() {
  while (true) {
    const auto first = earliest();
    if (!first) return std::nullopt;
    Part& part = parts_[*first];
    const Time time = part.waiting.front().time;
    if (lacks(time)) return give();
    take(part);
    if (is_whole(time)) return give();
  }
}

}  // namespace aims
