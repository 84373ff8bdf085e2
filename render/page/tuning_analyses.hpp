// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "core/error.hpp"
#include "render/page/page_data.hpp"
#include "render/page/tuning_source.hpp"

namespace aims {

/// Values of an estimator's points in the order of the page; an empty one: the default setting.
using PagePoints = std::vector<std::vector<double>>;

/// The analysis of each objective of the plan and of each headline score, over the complete points
/// of that estimator, with the objective of each point and, of a tuning, what the held-out
/// sequences say of the best one.
Result<Json> analyses_json(const TuningSource& source, const std::string& estimator,
                           const PagePoints& points, PageData& page);

}  // namespace aims
