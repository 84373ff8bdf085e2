// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "core/error.hpp"

namespace aims {

/// Seeds of a text like "3", "1-5" or "1,4,7-9", in the order given, without repeats.
Result<std::vector<std::uint64_t>> parse_seeds(std::string_view text);

}  // namespace aims
