// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "bench/estimate/progress.hpp"
#include "bench/studies/paper_study.hpp"
#include "bench/studies/suite_summary.hpp"
#include "bench/studies/written_runs.hpp"
#include "cli/commands.hpp"
#include "cli/progress.hpp"
#include "cli/suite_options.hpp"
#include "cli/terminal.hpp"
#include "core/error.hpp"
#include "render/results/pictures.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

/// Draws each experiment's first seed, whose run lies in `folder` (bench/studies/written_runs.hpp),
/// as the paper's figures: SCENARIO-trajectories.png and SCENARIO-maps.png of LOAM, FAST-LIO2,
/// LeGO-LOAM and AIMS.
Result<void> draw_paper(const std::vector<PaperExperiment>& experiments,
                        const std::filesystem::path& folder, const DrawObserver& observer) {
  for (const PaperExperiment& each : experiments) {
    if (each.seeds.empty()) continue;
    auto drawn = draw_systems(suite_run_folder(folder, each.scenario, each.seeds.front()),
                              {"loam", "fast_lio2", "lego_loam", "aims"}, folder, observer);
    if (!drawn) return drawn;
  }
  return {};
}

/// The options with what the study sets where nothing is given: the paper's experiments and
/// systems, sensors as on real robots.
SharedOptions with_defaults(SharedOptions options) {
  if (options.named.empty() && options.scenarios.empty() && options.tags.empty()) {
    for (const PaperTable& table : paper_tables()) options.named.push_back(table.scenario);
  }
  if (options.estimators.empty()) options.estimators = paper_estimators();
  options.settings.insert(options.settings.begin(), "sensors=field");
  return options;
}

Result<void> write_results(const Suite& suite, const std::vector<PaperExperiment>& experiments,
                           const SharedOptions& shared) {
  const fs::path out = shared.out;
  remove_earlier_runs(out);
  auto written = write_suite(suite, out);
  if (written) written = write_suite_runs(suite, out);
  if (written) written = list_suite(out);
  if (written) written = write_paper(experiments, suite, out);
  if (!written) return written;
  DrawDisplay display(shared.quiet);
  return draw_paper(experiments, out, display.observer());
}

Result<int> study_paper(const SharedOptions& given) {
  const SharedOptions shared = with_defaults(given);
  const auto suite =
      run_study(shared, {.seeds = first_seeds(20), .outputs = {.trajectories = true}, .adapt = {}});
  if (!suite) return tl::unexpected(suite.error());
  const auto experiments = paper_study(*suite);
  if (!experiments) return tl::unexpected(experiments.error());
  auto written = write_results(*suite, *experiments, shared);
  if (!written) return tl::unexpected(written.error());
  print_out("Each cell: the paper's figure · the median here (the worst)\n\n");
  for (const PaperExperiment& each : *experiments) {
    print_out("{}, {}\n{}\n", each.title, each.scenario, to_text(system_table(each)));
  }
  print_out("Agreement with the paper's order\n{}\n", to_text(order_table(*experiments)));
  print_outcome(*suite, shared);
  print_out("results: {}\n", (fs::path(shared.out) / "paper.md").string());
  write_pages_of(shared.out, shared.quiet);
  return exit_code_of(*suite);
}

}  // namespace

void declare_paper(Command command, const fs::path& scenarios) {
  auto shared = std::make_shared<SharedOptions>();
  shared->folder = scenarios.string();
  add_suite_options(command, *shared, "out/paper", "1-20");
  add_estimators(command, *shared, "the systems of the paper, leg_kilo, tfs_plus, aims_d");
  command.footer(
      "Without scenarios corridor and garage, with sensors=field unless --set has another "
      "level.\n" +
      std::string(kContinues) +
      "Examples:\n"
      "  aims study paper\n"
      "  aims study paper corridor --seeds 1-10 --estimators fast_lio2,tfs,aims,leg");
  command.action([shared] { return exit_code_of("study paper", study_paper(*shared)); });
}

}  // namespace aims
