// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <limits>
#include <string>

#include "core/error.hpp"

namespace aims {

/// The text of a file in UTF-8: as it is, or converted from UTF-16 of either byte order with a byte
/// order mark, as Windows tools write it. Errors: as of `read_file`, and "name: ..." for UTF-16
/// without the mark, a lone surrogate, an odd number of bytes, or UTF-32.
Result<std::string> read_text_file(const std::filesystem::path& file,
                                   std::size_t most = std::numeric_limits<std::size_t>::max());

/// The same of the bytes of a file of that name.
Result<std::string> utf8_of(std::string bytes, const std::string& name);

}  // namespace aims
