// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/source/spread_batches.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "core/median.hpp"
#include "recordings/bag/wrapped_source.hpp"
#include "recordings/messages/inertial_topics.hpp"
#include "recordings/messages/message_decoder.hpp"
#include "recordings/messages/message_values.hpp"
#include "recordings/messages/robot_states.hpp"
#include "recordings/source/leg_topics.hpp"

namespace aims {
namespace {

constexpr std::size_t kFewestMessages = 30;  ///< of a topic
constexpr std::size_t kFirstMessages = 2000;
constexpr Duration kFirstSpan = 10 * kSecond;
constexpr std::size_t kMostRead = 100'000;  ///< of all topics
constexpr std::size_t kMostHeld = 10'000;   ///< messages
constexpr std::size_t kMostHeldBytes = 64U << 20;

bool is_candidate(const BagConnection& connection) {
  const std::string& type = connection.type;
  if (connection.messages < kFewestMessages) return false;
  return type == "sensor_msgs/Imu" || type == "nav_msgs/Odometry" ||
         type.starts_with("geometry_msgs/Twist") || inertial_half(connection.topic) ||
         may_be_of_legs(connection) ||
         robot_state_of(connection.type, connection.definition) != nullptr;
}

/// Record times and stamps of the first messages of a topic.
struct FirstTimes {
  MessageDecoder decoder;
  std::vector<Time> recorded = {};
  Time stamp = 0;         ///< of the last message; 0: none
  std::size_t steps = 0;  ///< of stamps
  bool enough = false;

  void add(const BagMessage& message) {
    if (enough) return;
    constexpr std::size_t kEnoughSteps = 100;
    const auto view = decoder.decode(message.data);
    const Time found = view ? recorded_stamp(*view).value_or(0) : 0;
    steps += !recorded.empty() && found != stamp ? 1 : 0;
    stamp = found;
    recorded.push_back(message.record_time);
    enough = recorded.size() == kFirstMessages || steps == kEnoughSteps ||
             message.record_time - recorded.front() > kFirstSpan;
  }

  /// Whether stamps are zero, or of a clock that stands.
  bool are_unstamped() const {
    constexpr std::size_t kMostSteps = 5;  // one of so many
    return kMostSteps * steps <= recorded.size();
  }
};

/// The first times of all candidates, by connection.
std::map<std::uint32_t, FirstTimes> first_times(MessageSource& source) {
  std::map<std::uint32_t, FirstTimes> times;
  std::set<std::string> topics;
  for (const BagConnection& each : source.connections()) {
    if (!is_candidate(each)) continue;
    auto decoder = MessageDecoder::create(each.type, each.definition, each.format);
    if (!decoder) continue;
    times.emplace(each.id, FirstTimes{std::move(*decoder)});
    topics.insert(each.topic);
  }
  source.select(std::vector<std::string>(topics.begin(), topics.end()));
  source.rewind();
  const auto open = [&times] {
    return std::ranges::any_of(times, [](const auto& each) { return !each.second.enough; });
  };
  for (std::size_t i = 0; i < kMostRead && open(); ++i) {
    const auto message = source.next();  // a broken file is reported where it is read
    if (!message || !*message) break;
    const auto topic = times.find((*message)->connection->id);
    if (topic != times.end()) topic->second.add(**message);
  }
  return times;
}

class SpreadSource final : public WrappedSource {
 public:
  SpreadSource(std::unique_ptr<MessageSource> source, std::map<std::uint32_t, BatchRate> rates)
      : WrappedSource(std::move(source)), rates_(std::move(rates)) {
    for (BagConnection& each : connections_) {
      const auto rate = rates_.find(each.id);
      if (rate != rates_.end()) each.batch = rate->second.samples;
    }
    restart();
  }

  void rewind() override {
    WrappedSource::rewind();
    restart();
  }

  Result<std::optional<BagMessage>> next() override {
    lent_.reset();
    while (held_.empty() || !held_.front().ready) {
      if (ended_) break;
      auto message = read();
      if (!message) return message;
      if (!*message) {
        ended_ = true;
        close_all();
        continue;
      }
      const BagMessage& given = **message;
      close_before(given.record_time);
      const bool spread = rates_.contains(given.connection->id);
      if (held_.empty() && !spread) return message;
      hold(given, spread);
    }
    if (held_.empty()) return std::optional<BagMessage>();
    lent_ = std::move(held_.front());
    held_.pop_front();
    ++first_;
    held_bytes_ -= lent_->data.size();
    return BagMessage{lent_->connection, lent_->record_time, lent_->data, lent_->offset,
                      lent_->sampled};
  }

 private:
  struct Held {
    const BagConnection* connection = nullptr;
    Time record_time = 0;
    std::vector<std::byte> data;
    std::uint64_t offset = 0;
    std::optional<Time> sampled = std::nullopt;
    bool ready = false;
  };

  /// The batch of a topic to which samples may still come.
  struct Batch {
    BatchClock clock;
    Duration within = 0;
    std::vector<std::size_t> places = {};  ///< of its samples, counted from the first one ever held
    Time last = 0;                         ///< record time
  };

  void restart() {
    held_.clear();
    lent_.reset();
    batches_.clear();
    for (const auto& [id, rate] : rates_)
      batches_.emplace(id, Batch{BatchClock(rate), rate.within});
    first_ = held_bytes_ = 0;
    ended_ = false;
  }

  void hold(const BagMessage& message, bool spread) {
    if (spread) {
      Batch& batch = batches_.at(message.connection->id);
      batch.places.push_back(first_ + held_.size());
      batch.last = message.record_time;
    }
    held_.push_back({message.connection,
                     message.record_time,
                     {message.data.begin(), message.data.end()},
                     message.offset});
    held_.back().ready = !spread;
    held_bytes_ += message.data.size();
    if (held_.size() > kMostHeld || held_bytes_ > kMostHeldBytes) close_all();
  }

  void close(Batch& batch) {
    const auto times = batch.clock.add(batch.last, batch.places.size());
    for (std::size_t i = 0; i < times.size(); ++i) {
      Held& each = held_[batch.places[i] - first_];
      each.sampled = times[i];
      each.ready = true;
    }
    batch.places.clear();
  }

  /// Closes the batches that a message of that record time does not belong to.
  void close_before(Time record_time) {
    for (auto& [id, batch] : batches_) {
      if (!batch.places.empty() && record_time - batch.last > batch.within) close(batch);
    }
  }

  void close_all() {
    for (auto& [id, batch] : batches_) {
      if (!batch.places.empty()) close(batch);
    }
  }

  std::map<std::uint32_t, BatchRate> rates_;  ///< by connection
  std::map<std::uint32_t, Batch> batches_;
  std::deque<Held> held_;
  std::optional<Held> lent_;
  std::size_t first_ = 0;  ///< place of the first that is held
  std::size_t held_bytes_ = 0;
  bool ended_ = false;
};

}  // namespace

std::optional<BatchRate> batch_rate(const std::vector<Time>& record_times) {
  constexpr double kLeastWithin = 0.4;  // of the steps
  constexpr std::size_t kFewest = 6;    // batches
  constexpr double kTolerance = 0.3;    // of the rate of a batch
  constexpr double kSteady = 0.8;       // of the batches
  if (record_times.size() < 2 * kFewest) return std::nullopt;
  const Duration whole = record_times.back() - record_times.front();
  const auto steps = static_cast<Duration>(record_times.size() - 1);
  BatchRate rate;
  rate.within = whole / steps / 4;
  std::vector<std::pair<Time, std::size_t>> batches;  // record time and samples
  std::size_t within = 0;
  for (std::size_t i = 0; i < record_times.size(); ++i) {
    const bool same = i > 0 && record_times[i] - record_times[i - 1] <= rate.within;
    within += same ? 1 : 0;
    if (!same) batches.emplace_back(record_times[i], 0);
    batches.back().first = record_times[i];
    ++batches.back().second;
  }
  const bool batched = static_cast<double>(within) >= kLeastWithin * static_cast<double>(steps);
  if (!batched || batches.size() < kFewest) return std::nullopt;
  batches.pop_back();  // perhaps cut off
  std::vector<double> periods;
  std::size_t samples = 0;
  for (std::size_t i = 1; i < batches.size(); ++i) {
    const auto& [time, count] = batches[i];
    periods.push_back(static_cast<double>(time - batches[i - 1].first) /
                      static_cast<double>(count));
    samples += count;
  }
  const double usual = *upper_median(periods);
  const auto steady = std::ranges::count_if(
      periods, [&](double each) { return std::abs(each - usual) <= kTolerance * usual; });
  if (static_cast<double>(steady) < kSteady * static_cast<double>(periods.size())) {
    return std::nullopt;
  }
  rate.period = static_cast<double>(batches.back().first - batches.front().first) /
                static_cast<double>(samples);
  rate.samples = static_cast<double>(samples) / static_cast<double>(periods.size());
  return rate;
}

std::vector<Time> BatchClock::add(Time record_time, std::size_t samples) {
  constexpr double kGain = 0.2;  // by which the end of a batch follows its record time
  const double length = rate_.period * static_cast<double>(samples);
  double end = static_cast<double>(record_time - end_.value_or(record_time));
  const double off = end - length;  // of the record time from when it is expected
  const bool follows = end_ && off > 0.0 && off < std::max(length, 3.0 * rate_.period);
  if (follows) end = length + kGain * off;
  const bool anew = !end_ || (!follows && off > 0.0);
  const double step = anew ? rate_.period : end / static_cast<double>(samples);
  std::vector<Time> times;
  for (std::size_t i = 0; i < samples; ++i) {
    const auto back = static_cast<Duration>(step * static_cast<double>(samples - 1 - i));
    const Time time = end_.value_or(record_time) + static_cast<Duration>(end) - back;
    times.push_back(std::max<Time>(0, time));
  }
  end_ = times.back();
  return times;
}

void spread_batches(std::unique_ptr<MessageSource>& source) {
  std::map<std::uint32_t, BatchRate> rates;
  for (const auto& [id, times] : first_times(*source)) {
    if (!times.are_unstamped()) continue;
    if (const auto rate = batch_rate(times.recorded)) rates.emplace(id, *rate);
  }
  start_anew(*source);
  if (rates.empty()) return;
  source = std::make_unique<SpreadSource>(std::move(source), std::move(rates));
}

}  // namespace aims
