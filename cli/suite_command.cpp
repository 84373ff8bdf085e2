// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "bench/scoring/run_failure.hpp"
#include "bench/scoring/score_table.hpp"
#include "bench/studies/families.hpp"
#include "bench/studies/suite_summary.hpp"
#include "bench/studies/written_runs.hpp"
#include "cli/commands.hpp"
#include "cli/json_output.hpp"
#include "cli/options.hpp"
#include "cli/suite_options.hpp"
#include "cli/terminal.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

struct SuiteArguments {
  SharedOptions shared;
  bool trajectories = false;
  bool no_page = false;
  bool json = false;
};

void print_matrix(const std::string& title, const TextTable& table) {
  print_out("{}\n{}\n", title, to_text(table));
}

/// More scenarios than this are one table per score, not one per scenario.
constexpr std::size_t kMostTables = 6;

/// The table of scores of each scenario, as `aims run` prints it.
void print_scenarios(const Suite& suite) {
  std::vector<std::span<const RunRecord>> tables;
  const SuiteCase* last = nullptr;
  for (const SuiteCase& each : suite.cases) {
    if (each.runs.empty()) continue;
    print_out("{}\n", each.scenario.name);
    print_scores_table(score_table(each.runs), "suite.md");
    for (const std::string& line : failure_lines(each.runs)) print_out("no success: {}\n", line);
    print_invalid_poses(each);
    print_out("\n");
    tables.emplace_back(each.runs);
    last = &each;
  }
  if (last != nullptr) print_out("{}\n", legend_of_tables(tables, last->scenario.scoring));
}

void print_matrices(const Suite& suite) {
  print_out("Median [95 % bootstrap interval] worst, over seeds\n\n");
  for (const Score& score : headline_scores()) {
    const std::string key = score.key;
    if (key == "max_error_z_m" || key == "m_end_m") continue;  // in suite.md
    print_matrix(fmt::format("{} [{}]", score.title, score.unit), headline_table(suite, score));
  }
  for (const Score& score : success_scores()) {
    print_matrix(fmt::format("Success {} of the distance, with 95 % interval", score.title),
                 success_table(suite, score));
  }
}

void print_suite(const Suite& suite, const SharedOptions& shared) {
  if (suite.cases.size() <= kMostTables) {
    print_scenarios(suite);
  } else {
    print_matrices(suite);
  }
  const TextTable pairs = success_pairs_table(suite, false);
  if (!pairs.rows.empty()) print_matrix("Pairs of estimators (sign test over seeds)", pairs);
  const auto families = family_results(suite);
  if (!families.empty()) print_matrix("Breakdown level", breaks_table(families));
  print_ring_notes(suite);
  print_expectations(suite);
  print_outcome(suite, shared);
  print_calibration_warnings(suite, shared);
  print_out("results: {}, suite.json, suite.csv\n", (fs::path(shared.out) / "suite.md").string());
}

Result<void> write_results(const Suite& suite, const SuiteArguments& arguments) {
  const fs::path out = arguments.shared.out;
  remove_earlier_runs(out);
  auto written = write_suite(suite, out);
  if (written && arguments.trajectories) written = write_suite_runs(suite, out);
  return written ? list_suite(out) : written;
}

Result<Answer> suite_command(const SuiteArguments& arguments) {
  const SharedOptions& shared = arguments.shared;
  auto options = suite_options(shared, {});
  if (!options) return tl::unexpected(options.error());
  options->jobs.outputs.trajectories = arguments.trajectories;
  auto scenarios = scenarios_of(shared);
  if (!scenarios) return tl::unexpected(scenarios.error());
  const auto suite = run_with_display(std::move(*scenarios), *options, shared.quiet);
  if (!suite) return tl::unexpected(suite.error());
  if (auto written = write_results(*suite, arguments); !written) {
    return tl::unexpected(written.error());
  }
  print_suite(*suite, shared);
  if (!arguments.no_page) write_pages_of(shared.out, shared.quiet);
  return Answer{exit_code_with_expectations(*suite), suite_document(*suite)};
}

}  // namespace

void declare_suite(Command command, const fs::path& scenarios) {
  auto arguments = std::make_shared<SuiteArguments>();
  SharedOptions& shared = arguments->shared;
  shared.folder = scenarios.string();
  add_suite_options(command, shared, "out/suite", "those of each scenario");
  add_estimators(command, shared, "those of each scenario");
  add_calibration(command, shared);
  command.flag("--trajectories", arguments->trajectories,
               "Keep trajectories and diagnostics of each run");
  command.flag("--no-page", arguments->no_page, "Write no HTML pages");
  add_json(command, arguments->json);
  command.footer(
      "Without scenarios and tags, every scenario of the folder runs. The same command\n"
      "again continues, and runs only what is missing or has changed.\n"
      "Examples:\n"
      "  aims suite --tags severity --seeds 1-10 --out out/severity\n"
      "  aims suite corridor corridor_smooth --seeds 1-5 --estimators aims,lio\n"
      "  aims suite --tags stress --seeds 1-3 --set estimators.aims.degeneracy.eta=5 --out "
      "out/eta5");
  command.action([arguments] {
    return answer("suite", arguments->json, [&] { return suite_command(*arguments); });
  });
}

}  // namespace aims
