// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "core/error.hpp"
#include "recordings/bag/message_sink.hpp"
#include "recordings/source/conversion.hpp"
#include "recordings/source/recording_file.hpp"

namespace aims {

/// Writes the messages that a live estimate reads, with their arrivals as record times, so that
/// `aims estimate` finds what the estimator got.
class Recorder {
 public:
  /// `file`: .mcap for messages of ROS 2, .bag for ROS 1; empty: nothing is written. Error when it
  /// exists, cannot be written or is of the other kind.
  static Result<Recorder> create(const std::filesystem::path& file, MessageFormat format);

  /// Errors are kept for `close`: a full disk must not end the estimate.
  void add(const BagMessage& message);

  /// Empties the file; errors as those of `add`.
  void begin_again();

  /// The first error of `add`: from then on nothing is recorded.
  const Result<void>& state() const { return state_; }

  /// Completes the file. The first error, of `add` too.
  Result<void> close();

 private:
  Result<void> open();

  std::filesystem::path file_;  ///< empty: nothing is written
  RecordingFormat kind_ = RecordingFormat::kMcap;
  std::unique_ptr<MessageSink> sink_;
  std::optional<MessageConverter> converter_;
  /// By topic, type and its sum: ids of the messages are those of their sources.
  std::map<std::array<std::string, 3>, BagConnection> connections_;
  Result<void> state_;
};

}  // namespace aims
