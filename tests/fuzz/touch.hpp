// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

#include "recordings/messages/message_decoder.hpp"
#include "recordings/recording_config.hpp"

namespace aims {

/// Decodes the bytes and looks at everything that a view offers.
void touch_message(const MessageDecoder& decoder, std::span<const std::byte> bytes);

/// Reads a recording to its end, as `config` says.
void touch_recording(const std::filesystem::path& bag, bool recover,
                     const RecordingConfig& config = {});

}  // namespace aims
