// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "core/error.hpp"
#include "recordings/bag/message_source.hpp"

namespace aims {

/// Where a recording has one record time for all of its messages, as some converters write it,
/// replaces `source` by one whose messages are recorded at the latest stamp of those before them in
/// the file; its summary says so. Without stamps nothing changes. Reads the recording once;
/// rewinds.
Result<void> restore_record_times(std::unique_ptr<MessageSource>& source);

}  // namespace aims
