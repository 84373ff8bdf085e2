// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace aims {

/// Whether stamps of `count` messages, of which `steps` differ from the one before, are none to
/// read: zero, or of a clock that stands still or counts whole seconds.
constexpr bool hardly_advance(std::size_t steps, std::size_t count) {
  return count >= 3 && steps * 5 < count;
}

}  // namespace aims
