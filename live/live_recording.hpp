// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>

#include "core/error.hpp"
#include "core/time.hpp"
#include "live/commands.hpp"
#include "live/live_source.hpp"
#include "live/transport.hpp"
#include "recordings/stream/recording_reader.hpp"

namespace aims {

/// The last message of /tf_static by the frames that it places.
using LiveTransforms = std::map<std::string, LiveMessage>;

struct LiveRecordingOptions {
  RecordingConfig config;
  Duration settle = 3 * kSecond;     ///< gathered of each topic before units and so on are decided
  double patience = 0.0;             ///< timeout without the needed topics [s]; 0: none
  Duration max_wait = kSecond / 20;  ///< of a cloud, once the estimator has caught up
  LiveSource::Observer observer;     ///< sees all messages of the gathered topics; none: nobody
  ClockWatch* clocks = nullptr;      ///< once it is broken, reading ends
  LiveTransforms* transforms = nullptr;  ///< heard before, used where they are not sent again
  /// Error unless the setup suffices, naming what is missing.
  std::function<Result<void>(const RecordingSetup& setup)> check_setup;
  /// Called every few seconds with what is missing.
  std::function<void(const std::string&)> waiting;
  /// Called where what the observer saw counts no longer: the clock of arrivals was set back.
  std::function<void()> record_again;
};

/// Gathers all topics of the network until topics, units and extrinsics can be decided as for a bag
/// and `check_setup` passes; then, without an observer, only those that are used. Reading ends when
/// the node is asked to end or to start anew. Nothing when the node is asked to end before; error
/// after the timeout.
Result<std::optional<RecordingReader>> open_live_recording(Transport& transport, Commands& commands,
                                                           const LiveRecordingOptions& options);

}  // namespace aims
