// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace aims {

// What the languages of message definitions have in common: limits, which hostile files reach, and
// words.

inline constexpr std::size_t kMaxDefinedTypes = 512;
inline constexpr std::size_t kMaxDefinedFields = 4096;  ///< of a type

inline constexpr std::string_view kBlank = " \t\r\f\v";  ///< but for ends of lines

/// A letter, then letters, digits and underscores; 128 bytes at most.
bool is_name(std::string_view text);

/// A line between two types: three '=' or more, and nothing else.
bool is_separator(std::string_view line);

/// A whole number above 0, or nothing.
std::optional<std::uint32_t> count_in(std::string_view digits);

}  // namespace aims
