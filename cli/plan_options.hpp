// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "cli/options.hpp"
#include "core/config.hpp"
#include "core/error.hpp"

namespace aims {

/// What `aims sweep` and `aims tune` have in common: scenarios, seeds, estimators, --param, --set,
/// cache, --jobs, --retry and --quiet. Each is also a key of their plans.
void add_plan_options(Command& command, SharedOptions& options, const std::string& param_forms);

/// What was given replaces what the plan has, but --set, which comes on top of it.
template <class Plan>
void put_on_top(const SharedOptions& options, Plan& plan) {
  if (!options.scenarios.empty() || !options.tags.empty()) {
    plan.scenarios = options.scenarios;
    plan.tags = options.tags;
  }
  if (!options.param.empty()) plan.params = options.param;
  if (!options.seeds.empty()) plan.seeds = options.seeds;
  plan.set.insert(plan.set.end(), options.settings.begin(), options.settings.end());
}

}  // namespace aims
