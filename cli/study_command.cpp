// SPDX-License-Identifier: BSD-3-Clause
#include "cli/commands.hpp"

namespace aims {

void declare_study(Command command, const std::filesystem::path& scenarios) {
  declare_ablation(
      command.subcommand("ablation", "The effect of each switch of an estimator on its scores"),
      scenarios);
  declare_sensitivity(
      command.subcommand("sensitivity", "The effect of halving and doubling each setting"),
      scenarios);
  declare_consistency(
      command.subcommand("consistency",
                         "Errors along the weak axis against stated covariance and lower bound"),
      scenarios);
  declare_detectors(
      command.subcommand("detectors",
                         "ROC of the degeneracy indices of an estimator against the truth"),
      scenarios);
  declare_faults(command.subcommand("faults", "Estimators under every fault of their input"),
                 scenarios);
  declare_compare(
      command.subcommand("compare", "Scores that got better or worse between two folders"));
  declare_groups(command.subcommand("groups", "Scores by a quantity that the seeds drew"));
  declare_paper(command.subcommand("paper", "The paper's tables with every compared system"),
                scenarios);
  command.footer(
      "Examples:\n"
      "  aims study ablation severity_3 severity_8 --seeds 1-3\n"
      "  aims study compare out/before out/after");
}

}  // namespace aims
