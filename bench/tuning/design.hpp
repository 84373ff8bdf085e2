// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "estimator/estimator_spec.hpp"

namespace aims {

/// What a parameter is varied over. Written `KEY=LOW:HIGH:COUNT` or `KEY=log(LOW,HIGH,COUNT)`; the
/// count, which a grid alone needs, may be left out.
struct ParameterRange {
  std::string key;    ///< of the estimator, e.g. "degeneracy.eta", or else the scenario's own
  double low = 0.0;   ///< in the parameter's own unit
  double high = 0.0;  ///< in the parameter's own unit, >= low
  int count = 0;      ///< values on a grid, both ends included; 0: not stated
  bool log = false;   ///< evenly spaced in the logarithm
  bool of_estimator = true;    ///< false: of the simulation or the scoring
  std::string estimator = {};  ///< the only one that is varied; empty: any

  bool operator==(const ParameterRange&) const = default;
};

/// How points are laid into the box of several ranges.
enum class DesignKind {
  kGrid,            ///< every combination of every range's values
  kRandom,          ///< independent and uniform
  kSobol,           ///< Sobol's sequence with a random digital shift
  kLatinHypercube,  ///< each range in as many strata as points, one point in each
};

/// Most points of a design.
inline constexpr std::size_t kMostPoints = 10'000'000;

/// The range that `text` describes. Errors name the text and what was expected: no number, a
/// reversed or empty range, fewer values than its ends need, the logarithm of what is not positive.
/// `range_key` (bench/tuning/range_key.hpp) finds whose key it is.
Result<ParameterRange> parse_range(std::string_view text);

/// The text that `parse_range` reads.
std::string text_of(const ParameterRange& range);

/// Points of that design: a grid's from its ranges alone, `samples` of every other. Error for no
/// range, a grid's range without a count, no sample, and more than `kMostPoints` points.
Result<std::size_t> design_size(DesignKind kind, std::span<const ParameterRange> ranges,
                                int samples);

/// The value at `fraction` in [0, 1] of the range (of its logarithm in a logarithmic range),
/// rounded to twelve digits, so that it is the same with every mathematics library.
double value_at(const ParameterRange& range, double fraction);

/// Where `value` lies in the range: 0 = low, 1 = high; 0.5 in a range of one value.
double fraction_of(const ParameterRange& range, double value);

/// A value per range and point. On a grid the last range varies fastest. Otherwise the points
/// follow from the seed (stream "sweep.design"), and of `kRandom` and `kSobol` the first points do
/// not depend on how many follow. Expects what `design_size` and `check_ranges` accept.
std::vector<std::vector<double>> design(DesignKind kind, std::span<const ParameterRange> ranges,
                                        int samples, std::uint64_t seed);

/// `base` with the point's values of the estimator's parameters on top: they replace settings of
/// the same keys. A parameter that is a whole number in `configs` is rounded.
EstimatorSpec spec_at(const EstimatorSpec& base, std::span<const ParameterRange> ranges,
                      std::span<const double> point, const EstimatorConfigs& configs = {});

}  // namespace aims
