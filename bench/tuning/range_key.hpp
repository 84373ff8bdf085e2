// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bench/scenario/scenario.hpp"
#include "bench/tuning/design.hpp"
#include "core/config.hpp"
#include "core/error.hpp"

namespace aims {

/// What the key of a range means.
struct RangeKey {
  std::string name;          ///< in results: relative to the estimator where it is the estimator's
  bool of_estimator = true;  ///< else of the simulation or the scoring
  std::string estimator = {};  ///< the only one that is varied; empty: any
};

/// The key that `given` names: `degeneracy.eta`, `estimators.*.degeneracy.eta` and, of one alone,
/// `estimators.aims.degeneracy.eta` are the estimator's, `links.lidar.loss` and
/// `scenario.links.lidar.loss` the scenario's; a key that no estimator has counts as the
/// scenario's, existing or not. With a class `in_python`, a key that nothing has counts as its, and
/// `estimators.LABEL.gain` is that of its label. Error for a key that both have.
Result<RangeKey> range_key(std::string_view given, bool in_python = false);

/// The full key in a scenario of a range whose key is the `name` of a `RangeKey`.
std::string full_key(const ParameterRange& range);

/// What the parameter that is varied may be; anything for one that only an estimator in Python has.
Range allowed_values(const ParameterRange& range);

/// Reads ranges, with their keys as results name them, of estimators with these specs.
Result<std::vector<ParameterRange>> parse_ranges(std::span<const std::string> texts,
                                                 std::span<const std::string> estimators);

/// Error for a key that neither `base` nor one of its `estimators` has (with a near match), that
/// has no effect in it, is not a number or decides no number of a run, for a bound that its
/// parameter does not allow, and for two ranges of one key. Expects what `parse_ranges` yields.
Result<void> check_ranges(std::span<const ParameterRange> ranges, const Scenario& base,
                          std::span<const EstimatorSpec> estimators);

/// The values found, beside the defaults: "degeneracy.eta 0.13 instead of 3, degeneracy.kappa 10 as
/// by default". One in the outermost 2 % of its range is said to be there: "degeneracy.eta 0.13
/// instead of 3 (at the lower edge of its range 0.1 to 20: the optimum may lie outside)". One
/// without effect stays as by default.
std::string values_text(std::span<const ParameterRange> ranges, std::span<const double> defaults,
                        std::span<const double> values,
                        const std::vector<bool>& without_effect = {});

}  // namespace aims
