// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace aims {

/// Code of NaN in a quantized column.
inline constexpr std::uint16_t kNoCode = 65535;

/// A column as 16-bit codes: value = low + step * code, or exp of that.
struct QuantizedColumn {
  bool logarithmic = false;
  double low = 0.0;
  double step = 0.0;
  std::vector<std::uint16_t> codes;  ///< `kNoCode`: NaN
};

/// How exact a quantized column must be.
struct Precision {
  double least_step = 0.0;  ///< no finer steps than this, in the unit of the values
  /// Half of the values that are not zero must be exact to this fraction; 0: whatever the range is.
  double relative = 1e-3;
};

/// The codes of a column: linear over its range, or logarithmic where all values are positive and
/// span more than three decades. None when that misses the precision, or a value is infinite.
std::optional<QuantizedColumn> quantized(std::span<const double> values,
                                         const Precision& precision = {});

}  // namespace aims
