// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>

namespace aims {

/// Instant in nanoseconds since the start of the recording (or its epoch, for a robot's bag).
using Time = std::int64_t;
/// Span between two instants in nanoseconds.
using Duration = std::int64_t;

inline constexpr Duration kMillisecond = 1'000'000;
inline constexpr Duration kSecond = 1'000'000'000;

/// Nanoseconds as seconds, for use inside a formula.
constexpr double to_seconds(Duration duration) { return static_cast<double>(duration) * 1e-9; }

/// Seconds as nanoseconds, rounded to the nearest.
inline Duration from_seconds(double seconds) { return std::llround(seconds * 1e9); }

}  // namespace aims
