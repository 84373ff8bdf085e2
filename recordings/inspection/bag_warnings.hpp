// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "recordings/inspection/bag_info.hpp"

namespace aims {

/// Problems of the bag for an estimator, each with its remedy, one sentence each.
std::vector<std::string> bag_warnings(const BagInfo& info);

}  // namespace aims
