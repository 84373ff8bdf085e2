// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/stream/repeated_samples.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

#include "core/median.hpp"
#include "recordings/messages/message_values.hpp"

namespace aims {
namespace {

constexpr std::size_t kMinSamples = 10;

void append(const MessageView& message, std::string_view path, std::vector<double>& out) {
  if (path.empty()) return;
  if (const auto numbers = numbers_at(message, path)) {
    out.insert(out.end(), numbers->begin(), numbers->end());
  } else if (const auto points = points_at(message, path)) {
    for (const Eigen::Vector3d& each : *points) out.insert(out.end(), each.begin(), each.end());
  }
}

}  // namespace

std::vector<double> sample_numbers(const MessageView& message, const Channel& channel) {
  std::vector<double> numbers;
  const bool has_imu =
      channel.state == nullptr ? channel.is(Role::kImu) : !channel.state->imu.empty();
  EventCounts ignored;
  if (const auto sample = has_imu ? imu_at(message, 0, ignored) : std::nullopt) {
    for (const Eigen::Vector3d& each : {sample->angular_velocity, sample->specific_force}) {
      numbers.insert(numbers.end(), each.begin(), each.end());
    }
  }
  if (channel.state == nullptr) return numbers;
  const StateLayout& state = *channel.state;
  for (const auto path : {state.angles, state.rates, state.feet, state.contacts}) {
    append(message, path, numbers);
  }
  return numbers;
}

bool RepeatFinder::add(Time stamp, std::vector<double> numbers) {
  if (numbers.empty()) return true;
  const bool again = messages_++ > 0 && numbers == last_;
  if (!again) {
    stamps_.push_back(stamp);
    runs_.push_back(0);
    last_ = std::move(numbers);
  }
  ++runs_.back();
  return !again;
}

std::optional<Duration> RepeatFinder::period() const {
  if (stamps_.size() < kMinSamples) return std::nullopt;
  // The first and the last sample may be cut.
  std::vector<std::size_t> runs(runs_.begin() + 2, runs_.end() - 1);
  if (upper_median(runs).value_or(0) < 2) return std::nullopt;
  std::vector<Duration> steps;
  for (std::size_t i = 1; i < stamps_.size(); ++i) steps.push_back(stamps_[i] - stamps_[i - 1]);
  const Duration period = upper_median(steps).value_or(0);
  return period > 0 ? std::optional(period) : std::nullopt;
}

bool RepeatFilter::repeats(Time stamp, std::vector<double> numbers) {
  const bool recent =
      new_since_ && stamp >= *new_since_ && stamp - *new_since_ < period_ + period_ / 2;
  if (recent && numbers == last_) return true;
  new_since_ = stamp;
  last_ = std::move(numbers);
  return false;
}

}  // namespace aims
