// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "bench/jobs/job.hpp"
#include "bench/scenario/scenario.hpp"
#include "bench/tuning/design.hpp"
#include "core/error.hpp"

namespace aims {

/// A scenario with a point's values on top.
struct ScenarioVariant {
  std::shared_ptr<const Scenario> scenario;
  std::vector<ScenarioSetting> settings;  ///< per range of the scenario; empty: the scenario itself
  std::string sequence;  ///< equal for variants whose sequences are the same: other scoring alone
};

/// The variants of one scenario at points of a design, each made once, so that jobs on one sequence
/// share it. Ranges of the estimator's keys are ignored.
class ScenarioVariants {
 public:
  /// The ranges (as of `parse_ranges`, checked by `check_ranges`) must outlive the object.
  ScenarioVariants(std::shared_ptr<const Scenario> base, std::span<const ParameterRange> ranges);

  /// The scenario at a point, a value per range; whole numbers are rounded.
  Result<ScenarioVariant> at(std::span<const double> point);

  /// The scenario as it is.
  ScenarioVariant untouched() const { return {base_, {}, ""}; }

 private:
  struct Varied {
    std::size_t index = 0;      ///< of the range
    std::string full;           ///< its key in the scenario
    std::string default_value;  ///< of the scenario
    bool whole = false;         ///< a whole number
  };

  Result<ScenarioVariant> make(const std::vector<std::string>& values) const;

  std::shared_ptr<const Scenario> base_;
  std::span<const ParameterRange> ranges_;
  std::vector<Varied> varied_;
  std::map<std::vector<std::string>, ScenarioVariant> made_;
};

}  // namespace aims
