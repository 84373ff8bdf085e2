// SPDX-License-Identifier: BSD-3-Clause
#include <memory>
#include <string>

#include "bench/studies/detectors.hpp"
#include "bench/studies/suite_summary.hpp"
#include "cli/commands.hpp"
#include "cli/suite_options.hpp"
#include "cli/terminal.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

Result<int> study_detectors(SharedOptions shared) {
  const auto estimator = one_estimator(shared, "aims");
  if (!estimator) return tl::unexpected(estimator.error());
  shared.estimators = {*estimator};
  const auto suite =
      run_study(shared, {.seeds = first_seeds(5), .outputs = {.trajectories = true}, .adapt = {}});
  if (!suite) return tl::unexpected(suite.error());
  const auto study = detector_study(*suite, shared.out);
  if (!study) return tl::unexpected(study.error());
  auto written = write_suite(*suite, shared.out);
  if (written) written = write_detectors(*study, shared.out);
  if (!written) return tl::unexpected(written.error());
  print_out(
      "{} runs; AUC with 95 % interval over runs, detection rate at {:.0f} % false alarms, "
      "median delay, onsets missed\n{}\n",
      study->runs.size(), 100.0 * kFalseAlarms, to_text(detector_table(study->scores)));
  for (const std::string& warning : study->warnings) print_out("note: {}\n", warning);
  print_outcome(*suite, shared);
  print_out("results: {}\n", (fs::path(shared.out) / "detectors.md").string());
  write_pages_of(shared.out, shared.quiet);
  return exit_code_of(*suite);
}

}  // namespace

void declare_detectors(Command command, const fs::path& scenarios) {
  auto shared = std::make_shared<SharedOptions>();
  shared->folder = scenarios.string();
  add_suite_options(command, *shared, "out/detectors", "1-5");
  add_estimators(command, *shared, "aims; one");
  command.footer(std::string(kContinues) +
                 "Example:\n"
                 "  aims study detectors corridor corridor_smooth --seeds 1-5 --out out/detectors");
  command.action([shared] { return exit_code_of("study detectors", study_detectors(*shared)); });
}

}  // namespace aims
