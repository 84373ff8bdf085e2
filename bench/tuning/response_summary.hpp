// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "bench/tuning/analysis.hpp"
#include "bench/tuning/sensitivity.hpp"
#include "core/error.hpp"
#include "core/files/table.hpp"

namespace aims {

/// A figure with as many digits as serve: "0.0312", "12.3", "-" for none.
std::string figure_text(const std::optional<double>& value);

/// "0.0312 [0.029, 0.034]"; without brackets where there is no interval.
std::string figure_text(const std::optional<double>& value, const Interval& interval);

/// A row per parameter: range, default, best with its interval, distance of the best from the
/// default, and the Sobol indices, "not resolved" where they mean nothing.
TextTable parameter_table(const ResponseTable& table, const BestPoint& best,
                          const Sensitivity* sensitivity);

/// A row per scenario and one for all: median score of the defaults and of `point`, the objective
/// of the point with its interval over seeds, diverged runs of both.
TextTable gain_table(const ResponseTable& table, const Objective& objective, std::size_t point);

/// Markdown of the best point, of sensitivity indices with their source, negligible parameters and
/// interactions.
std::string response_markdown(const ResponseTable& table, const Objective& objective);

}  // namespace aims
