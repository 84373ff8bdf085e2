// SPDX-License-Identifier: BSD-3-Clause
#include "cli/plan_options.hpp"

namespace aims {

void add_plan_options(Command& command, SharedOptions& options, const std::string& param_forms) {
  add_scenarios(command, options);
  add_seeds(command, options, "those of the plan");
  add_estimators(command, options, "those of the plan");
  add_param(command, options, param_forms);
  add_settings(command, options, "each scenario");
  add_cache(command, options);
  add_jobs(command, options);
  add_retry(command, options);
  add_quiet(command, options);
}

}  // namespace aims
