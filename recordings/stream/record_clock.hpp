// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/time.hpp"

namespace aims {

/// Record times before the first cannot be true where others lie behind the second: the recorder's
/// clock was not set yet.
inline constexpr Time kUnsetRecordTime = kSecond;
inline constexpr Time kSetRecordTime = 100'000'000 * kSecond;

}  // namespace aims
