// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string_view>

#include "core/time.hpp"

namespace aims {

/// An instant as ISO 8601 writes it.
struct IsoTime {
  Time time = 0;          ///< since 1970, UTC
  bool has_zone = false;  ///< false: none is stated, and UTC is taken
};

/// "2023-05-01T12:00:00.123Z" as nanoseconds: a date, 'T' or a blank, a time of day with decimals
/// behind a point or comma, or without, and Z, an offset ("+02:00", "-0530") or nothing. Decimals
/// beyond nine are cut off. Nothing for other texts, or without the time of day.
std::optional<IsoTime> parse_iso_time(std::string_view text);

}  // namespace aims
