// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/source/stamped_source.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "recordings/source/message_stamps.hpp"

namespace aims {
namespace {

constexpr std::uint64_t kFewMessages = 10;  ///< may have one record time by chance

class StampedSource final : public MessageSource {
 public:
  StampedSource(std::unique_ptr<MessageSource> source, MessageStamps stamps, Time start, Time end)
      : source_(std::move(source)),
        stamps_(std::move(stamps)),
        summary_(source_->summary()),
        clock_(start) {
    summary_.start = start;
    summary_.end = end;
    summary_.recorded_at_stamps = true;
  }

  std::string name() const override { return source_->name(); }
  const std::vector<BagConnection>& connections() const override { return source_->connections(); }
  const BagSummary& summary() const override { return summary_; }
  void select(std::span<const std::string> topics) override { source_->select(topics); }

  Result<std::optional<BagMessage>> next() override {
    auto message = source_->next();
    if (!message || !*message) return message;
    clock_ = std::max(clock_, stamps_.of(**message).value_or(0));
    (*message)->record_time = clock_;
    return message;
  }

  void rewind() override {
    source_->rewind();
    clock_ = summary_.start;
  }

 private:
  std::unique_ptr<MessageSource> source_;
  MessageStamps stamps_;
  BagSummary summary_;
  Time clock_;  ///< latest stamp so far
};

}  // namespace

Result<void> restore_record_times(std::unique_ptr<MessageSource>& source) {
  const BagSummary& summary = source->summary();
  if (summary.start != summary.end || summary.messages < kFewMessages) return {};
  MessageStamps stamps(source->connections());
  std::optional<Time> start;
  Time end = 0;
  while (true) {
    const auto message = source->next();
    if (!message) return tl::unexpected(message.error());
    if (!*message) break;
    const auto stamp = stamps.of(**message);
    if (!stamp) continue;
    start = std::min(start.value_or(*stamp), *stamp);
    end = std::max(end, *stamp);
  }
  source->rewind();
  if (!start || *start == end) return {};
  source = std::make_unique<StampedSource>(std::move(source), std::move(stamps), *start, end);
  return {};
}

}  // namespace aims
