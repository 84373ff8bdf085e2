// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "recordings/bag/message_source.hpp"

namespace aims {

/// A recording whose record times ran faster than the time of its sensors by `rate`, with record
/// times as if they had not from `start` on. Those before it are of a clock that was not set yet,
/// and stay.
class RatedSource final : public MessageSource {
 public:
  RatedSource(std::unique_ptr<MessageSource> source, double rate, Time start);

  std::string name() const override { return source_->name(); }
  const std::vector<BagConnection>& connections() const override { return source_->connections(); }
  const BagSummary& summary() const override { return summary_; }
  void select(std::span<const std::string> topics) override { source_->select(topics); }
  Result<std::optional<BagMessage>> next() override;
  void rewind() override { source_->rewind(); }

 private:
  Time rated(Time record_time) const;

  std::unique_ptr<MessageSource> source_;
  double rate_;
  Time start_;
  BagSummary summary_;
};

}  // namespace aims
