// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

namespace aims {

/// Prepends the position to a message that begins with a dotted key ("route.points.0: ..."):
/// "file:line:column: " of the key, or of the nearest group around it that the file or one of its
/// bases has; "file: " when none has any part of it. `named` is as of `load_config`.
std::string with_position(const std::filesystem::path& file, const std::string& message,
                          const std::filesystem::path& named = {});

}  // namespace aims
