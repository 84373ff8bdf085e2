// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>

#include "core/error.hpp"
#include "core/time.hpp"
#include "live/commands.hpp"
#include "live/live_config.hpp"
#include "live/live_source.hpp"
#include "live/recorder.hpp"
#include "live/transport.hpp"
#include "recordings/stream/recording_reader.hpp"

namespace aims {

/// The last message of /tf_static by the frames that it places.
using LiveTransforms = std::map<std::string, LiveMessage>;

struct LiveRecordingOptions {
  LiveOptions live;
  RecordingConfig config;
  Recorder* recorder = nullptr;          ///< gets all messages of the gathered topics; none: nobody
  ClockWatch* clocks = nullptr;          ///< once it is broken, reading ends
  LiveTransforms* transforms = nullptr;  ///< heard before, used where they are not sent again
  /// Error unless the setup suffices, naming what is missing.
  std::function<Result<void>(const RecordingSetup& setup)> check_setup;
  /// Called every few seconds with what is missing.
  std::function<void(const std::string&)> waiting;
};

/// Gathers all topics of the network until topics, units and extrinsics can be decided as for a bag
/// and `check_setup` passes; then, without a recorder, only those that are used. Reading ends when
/// the node is asked to end or to start anew. Nothing when the node is asked to end before; error
/// after the timeout.
Result<std::optional<RecordingReader>> open_live_recording(Transport& transport, Commands& commands,
                                                           const LiveRecordingOptions& options);

}  // namespace aims
