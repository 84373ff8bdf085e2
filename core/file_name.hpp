// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string_view>

#include "core/error.hpp"

namespace aims {

/// Longest name that a file may get from a user's text [bytes]; with the endings that are added it
/// fits every file system.
inline constexpr std::size_t kMaxNameLength = 100;

/// Error, which begins with `key`, when a user's text cannot be the name of a file or a folder: it
/// is empty or too long, holds a separator, ".." or a control character, or begins with '.' or '-'.
Result<void> check_file_name(std::string_view key, std::string_view name);

}  // namespace aims
