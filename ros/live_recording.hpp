// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

#include "core/error.hpp"
#include "core/time.hpp"
#include "recordings/stream/recording_reader.hpp"
#include "ros/transport.hpp"

namespace aims {

struct LiveRecordingOptions {
  Duration settle = 3 * kSecond;  ///< gathered before the reader decides
  double patience = 0.0;          ///< given up after so long [s]; 0: never
};

/// Whether what was found will do; an error says what is missing.
using EnoughFound = std::function<Result<void>(const RecordingSetup& setup)>;

/// Takes the topics of the network, until topics, units and extrinsics can be decided as for a bag
/// and `enough` is content; from then on takes those that are used. While something is missing,
/// `waiting` is told what every few seconds. Error when the node was asked to end before, or
/// patience has run out.
Result<RecordingReader> open_live_recording(RosTransport& transport, const RecordingConfig& config,
                                            const LiveRecordingOptions& options,
                                            const EnoughFound& enough,
                                            const std::function<void(const std::string&)>& waiting);

}  // namespace aims
