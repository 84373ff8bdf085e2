// SPDX-License-Identifier: BSD-3-Clause
#include <memory>
#include <string>

#include "bench/studies/consistency_study.hpp"
#include "bench/studies/suite_summary.hpp"
#include "cli/commands.hpp"
#include "cli/suite_options.hpp"
#include "cli/terminal.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

Result<int> study_consistency(const SharedOptions& shared) {
  const auto suite =
      run_study(shared, {.seeds = first_seeds(10), .outputs = {.weak_axis = true}, .adapt = {}});
  if (!suite) return tl::unexpected(suite.error());
  const auto study = consistency_study(*suite, shared.out);
  if (!study) return tl::unexpected(study.error());
  auto written = write_suite(*suite, shared.out);
  if (written) written = write_consistency(*study, *suite, shared.out);
  if (!written) return tl::unexpected(written.error());
  print_out("Along the weak axis, over the sequence\n{}\n", to_text(consistency_table(*study)));
  print_out("At the end of the sequence, root mean square over seeds [m]\n{}\n",
            to_text(end_table(*study)));
  print_outcome(*suite, shared);
  print_out("results: {}, consistency.json, consistency.csv\n",
            (fs::path(shared.out) / "consistency.md").string());
  write_pages_of(shared.out, shared.quiet);
  return exit_code_of(*suite);
}

}  // namespace

void declare_consistency(Command command, const fs::path& scenarios) {
  auto shared = std::make_shared<SharedOptions>();
  shared->folder = scenarios.string();
  add_suite_options(command, *shared, "out/consistency", "1-10");
  add_estimators(command, *shared, "those of each scenario");
  command.footer(
      std::string(kContinues) +
      "Examples:\n"
      "  aims study consistency severity_3 severity_8 --seeds 1-50 --estimators aims_d,lio\n"
      "  aims study consistency severity_9 --estimators aims_d,no_cross_validation=aims_d+"
      "cross_validation.enabled=false");
  command.action(
      [shared] { return exit_code_of("study consistency", study_consistency(*shared)); });
}

}  // namespace aims
