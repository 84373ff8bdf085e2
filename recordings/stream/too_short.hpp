// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace aims {

/// "too short: 4 scans over 0.4 s ..." of a recording from which nothing can be judged; else
/// nothing. `scans`: none without a LiDAR. `seconds`: its length.
std::optional<std::string> too_short_text(std::optional<std::uint64_t> scans, double seconds);

}  // namespace aims
