// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <cstdlib>
#include <span>
#include <string>
#include <string_view>

#include "core/error.hpp"
#include "core/text.hpp"

namespace aims {

/// What a fuzzer takes for a defect when it does not hold.
inline void demand(bool condition) {
  if (!condition) std::abort();
}

/// A refusal is text that a terminal can show, of bounded length.
inline void demand_readable(const Error& error) {
  demand(!error.message.empty());
  demand(line_text(error.message).size() < 5000);
}

inline std::string_view text_of(std::span<const std::uint8_t> input) {
  return {reinterpret_cast<const char*>(input.data()), input.size()};
}

}  // namespace aims
