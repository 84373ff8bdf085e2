// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "core/error.hpp"
#include "recordings/bag/message_source.hpp"
#include "recordings/pcap/ouster_packets.hpp"

namespace aims {

/// The metadata of an Ouster whose packets are on `topic`: a std_msgs/String of a topic that ends
/// in "metadata", else NAME.json beside the recording. Rewinds it. Error for neither.
Result<OusterMetadata> recorded_ouster_metadata(MessageSource& source, const std::string& topic);

}  // namespace aims
