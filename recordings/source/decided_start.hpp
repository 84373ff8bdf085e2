// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "recordings/bag/message_source.hpp"

namespace aims {

/// Topic of the message that a live estimate records once it has decided topics, units and clocks.
inline constexpr const char* kDecidedTopic = "/aims/decided";

/// Whether a live estimate made the recording.
bool is_of_live_estimate(const MessageSource& recording);

/// The recording up to the message on `kDecidedTopic`: what a live estimate had when it decided.
class DecidedStart final : public MessageSource {
 public:
  /// `recording` must outlive it.
  explicit DecidedStart(MessageSource& recording) : recording_(recording) {}

  std::string name() const override { return recording_.name(); }
  const std::vector<BagConnection>& connections() const override {
    return recording_.connections();
  }
  const BagSummary& summary() const override { return recording_.summary(); }
  void select(std::span<const std::string> topics) override;
  Result<std::optional<BagMessage>> next() override;
  void rewind() override;

 private:
  MessageSource& recording_;
  bool ended_ = false;
};

}  // namespace aims
