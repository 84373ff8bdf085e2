// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/interface/diagnostics.hpp"

#include <algorithm>
#include <limits>

namespace aims {

std::optional<std::size_t> Diagnostics::find(std::string_view name) const {
  const auto found = std::ranges::find(series, name, &SeriesInfo::name);
  if (found == series.end()) return std::nullopt;
  return static_cast<std::size_t>(found - series.begin());
}

double Diagnostics::value(std::size_t scan, std::string_view name) const {
  const auto index = find(name);
  const std::vector<double>& values = scans[scan].values;
  return index && *index < values.size() ? values[*index]
                                         : std::numeric_limits<double>::quiet_NaN();
}

bool Diagnostics::updated(std::size_t scan) const { return value(scan, kIterationsSeries) != 0.0; }

}  // namespace aims
