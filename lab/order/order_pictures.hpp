// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "lab/order/order_study.hpp"
#include "core/error.hpp"

namespace aims {

/// Draws order.png into `folder`: the advantage of adaptive weights, and the agreement with the
/// paper's order, over the two conditions of the study's map; nothing without a map.
Result<void> draw_order(const OrderStudy& study, const std::filesystem::path& folder);

}  // namespace aims
