// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "recordings/inspection/bag_info.hpp"

namespace aims {

/// What in the bag will hurt an estimate, each with its remedy, in one sentence.
std::vector<std::string> bag_warnings(const BagInfo& info);

}  // namespace aims
