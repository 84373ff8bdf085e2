// SPDX-License-Identifier: BSD-3-Clause
#include "render/page/quantized.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace aims {
namespace {

constexpr double kLargestCode = kNoCode - 1;
constexpr double kLogarithmicFrom = 1000.0;  ///< ratio of the largest value to the smallest

/// Median of the absolute values that are neither zero nor NaN; infinite without any.
double typical_size(std::span<const double> values) {
  std::vector<double> sizes;
  for (const double value : values) {
    if (std::abs(value) > 0.0) sizes.push_back(std::abs(value));
  }
  if (sizes.empty()) return std::numeric_limits<double>::infinity();
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  return *middle;
}

}  // namespace

std::optional<QuantizedColumn> quantized(std::span<const double> values,
                                         const Precision& precision) {
  double min = std::numeric_limits<double>::infinity();
  double max = -min;
  for (const double value : values) {
    if (std::isnan(value)) continue;
    if (std::isinf(value)) return std::nullopt;
    min = std::min(min, value);
    max = std::max(max, value);
  }
  QuantizedColumn column;
  if (!(min <= max)) min = max = 0.0;
  column.logarithmic = precision.relative > 0.0 && min > 0.0 && max / min > kLogarithmicFrom;
  const auto law = [&](double value) { return column.logarithmic ? std::log(value) : value; };
  column.low = law(min);
  column.step = std::max((law(max) - column.low) / kLargestCode, precision.least_step);
  if (precision.relative > 0.0) {
    const double reach = column.logarithmic ? 1.0 : typical_size(values);
    if (column.step / 2.0 > precision.relative * reach) return std::nullopt;
  }
  column.codes.reserve(values.size());
  for (const double value : values) {
    const double code = column.step > 0.0 ? (law(value) - column.low) / column.step : 0.0;
    column.codes.push_back(std::isnan(value) ? kNoCode
                                             : static_cast<std::uint16_t>(std::lround(code)));
  }
  return column;
}

}  // namespace aims
