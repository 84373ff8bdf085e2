// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/source/stamped_source.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "recordings/messages/message_decoder.hpp"

namespace aims {
namespace {

constexpr std::uint64_t kFewMessages = 10;  ///< may have one record time by chance

/// Reads stamps of the connections that have one.
class Stamps {
 public:
  explicit Stamps(const std::vector<BagConnection>& connections) {
    for (const BagConnection& each : connections) {
      auto decoder = MessageDecoder::create(each.type, each.definition, each.format);
      if (decoder) decoders_.emplace(each.id, std::move(*decoder));
    }
  }

  /// That of the message, above 0.
  std::optional<Time> of(const BagMessage& message) const {
    const auto decoder = decoders_.find(message.connection->id);
    if (decoder == decoders_.end()) return std::nullopt;
    const auto view = decoder->second.decode(message.data);
    const auto stamp = view ? view->time("header.stamp") : std::nullopt;
    return stamp && *stamp > 0 ? stamp : std::nullopt;
  }

 private:
  std::map<std::uint32_t, MessageDecoder> decoders_;
};

class StampedSource final : public MessageSource {
 public:
  StampedSource(std::unique_ptr<MessageSource> source, Stamps stamps, Time start, Time end)
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
  Stamps stamps_;
  BagSummary summary_;
  Time clock_;  ///< latest stamp so far
};

}  // namespace

Result<void> restore_record_times(std::unique_ptr<MessageSource>& source) {
  const BagSummary& summary = source->summary();
  if (summary.start != summary.end || summary.messages < kFewMessages) return {};
  Stamps stamps(source->connections());
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
