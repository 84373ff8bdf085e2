// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace aims {

/// The word as a POSIX shell reads it back; a plain one as it is.
std::string shell_word(const std::string& word);

}  // namespace aims
