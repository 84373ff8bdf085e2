// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/time.hpp"

namespace aims {

/// Where a recording has record times after this, those before come from a recorder whose clock was
/// not set yet: they count from 1970 or from boot.
inline constexpr Time kSetRecordTime = 100'000'000 * kSecond;

}  // namespace aims
