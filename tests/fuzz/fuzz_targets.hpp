// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace aims {

// What is fed with any bytes: it may refuse them, but never crash, hang or take much memory.

/// The bytes of a bag: read by its index and by scanning, every message decoded; then as a
/// recording.
void fuzz_bag(std::span<const std::uint8_t> input);
/// A message definition, and the bytes of a message.
void fuzz_message(std::span<const std::uint8_t> input);
/// Messages of a robot's topics in a sound bag, their content free: read as a recording.
void fuzz_recording(std::span<const std::uint8_t> input);

}  // namespace aims
