// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/time.hpp"

namespace aims {

/// Where a recording has record times after `kSetRecordTime`, those before `kUnsetRecordTime` come
/// from a recorder whose clock was not set yet.
inline constexpr Time kUnsetRecordTime = kSecond;
inline constexpr Time kSetRecordTime = 100'000'000 * kSecond;

}  // namespace aims
