// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/source/recorder_clocks.hpp"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "core/median.hpp"
#include "recordings/source/message_stamps.hpp"

namespace aims {
namespace {

constexpr int kFirstMessages = 500;
constexpr Duration kFirstSpan = 5 * kSecond;
constexpr std::size_t kFewest = 10;               ///< messages of a topic
constexpr Duration kLongest = Duration{1} << 61;  ///< of what a clock can be off [ns]: 73 years
/// Between the latencies of sensors and recorders on one clock.
constexpr Duration kMaxSpread = kSecond / 4;

/// When a file was recorded, and by how much that is behind the stamps of its topics.
struct Clock {
  Time start = 0, end = 0;
  Duration latency = 0;
  std::set<std::string> topics;  ///< with stamps
};

struct Times {
  std::vector<Duration> latencies;  ///< record time minus stamp
  std::vector<Time> stamps;
};

/// The usual latency of a topic beyond the time between its messages: a cloud is sent at its end.
std::optional<Duration> latency_of(const Times& topic) {
  if (topic.stamps.size() < kFewest) return std::nullopt;
  std::vector<Duration> steps;
  for (std::size_t i = 1; i < topic.stamps.size(); ++i) {
    steps.push_back(topic.stamps[i] - topic.stamps[i - 1]);
  }
  const Duration period = std::clamp<Duration>(*upper_median(steps), 0, kSecond / 5);
  return *upper_median(topic.latencies) - period;
}

/// Stamps and latencies of the first messages of a file that have stamps, by topic; `start`: when
/// it begins with them.
std::map<std::string, Times> first_times(MessageSource& file, Time& start) {
  const MessageStamps stamps(file.connections());
  std::map<std::string, Times> topics;
  file.rewind();
  for (int i = 0; i < kFirstMessages; ++i) {
    const auto message = file.next();  // a broken file is reported where it is read
    if (!message || !*message) break;
    const Time recorded = (*message)->record_time;
    const auto stamp = stamps.of(**message);
    if (!stamp) continue;
    if (topics.empty()) start = recorded;
    if (recorded - start > kFirstSpan) break;
    Times& topic = topics[(*message)->connection->topic];
    topic.stamps.push_back(*stamp);
    topic.latencies.push_back(recorded - *stamp);
  }
  file.rewind();
  return topics;
}

/// Nothing where a file has no stamps.
std::optional<Clock> clock_of(MessageSource& file) {
  Clock clock = {0, file.summary().end, 0, {}};
  std::vector<Duration> latencies;
  for (const auto& [topic, times] : first_times(file, clock.start)) {
    const auto latency = latency_of(times);
    if (!latency) continue;
    latencies.push_back(*latency);
    clock.topics.insert(topic);
  }
  const auto latency = upper_median(std::move(latencies));
  if (!latency || std::abs(*latency) > kLongest || clock.end > 2 * kLongest) return std::nullopt;
  clock.latency = *latency;
  return clock;
}

/// How far both ends of two files are apart, with that shift of the second.
Duration apart(const Clock& a, const Clock& b, Duration shift) {
  return std::abs(b.start + shift - a.start) + std::abs(b.end + shift - a.end);
}

bool overlap(const Clock& a, const Clock& b, Duration shift) {
  return std::max(a.start, b.start + shift) < std::min(a.end, b.end + shift);
}

/// Whether the recorders of two files had clocks that differ by the shift. Else it is the sensors'
/// clocks that do, or they are parts of one recording.
bool is_of_another_recorder(const Clock& a, const Clock& b, Duration shift) {
  const bool parts = std::ranges::any_of(
      b.topics, [&a](const std::string& topic) { return a.topics.contains(topic); });
  if (parts || std::abs(shift) < kMaxSpread || !overlap(a, b, shift)) return false;
  return !overlap(a, b, 0) || 4 * apart(a, b, shift) < apart(a, b, 0);
}

}  // namespace

std::vector<Duration> recorder_clock_shifts(
    const std::vector<std::unique_ptr<MessageSource>>& files) {
  std::vector<std::optional<Clock>> clocks;
  const Clock* reference = nullptr;  // of the recorder that is nearest to the sensors' clock
  for (const auto& file : files) clocks.push_back(clock_of(*file));
  for (const auto& each : clocks) {
    if (!each) continue;
    const bool nearer =
        reference == nullptr || std::abs(each->latency) < std::abs(reference->latency);
    if (nearer) reference = &*each;
  }
  std::vector<Duration> shifts(files.size(), 0);
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (!clocks[i]) continue;
    const Duration shift = reference->latency - clocks[i]->latency;
    if (is_of_another_recorder(*reference, *clocks[i], shift)) shifts[i] = shift;
  }
  return shifts;
}

}  // namespace aims
