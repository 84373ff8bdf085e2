// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <optional>
#include <string>

#include "bench/jobs/job_store.hpp"
#include "bench/studies/comparison.hpp"
#include "cli/commands.hpp"
#include "cli/json_output.hpp"
#include "cli/options.hpp"
#include "cli/terminal.hpp"

namespace aims {
namespace {

constexpr const char* kCompareName = "study compare";

struct CompareArguments {
  std::string before;
  std::string after;
  SharedOptions shared;
  bool fail_on_worse = false;
  bool json = false;
};

/// Of results that differ on too few common seeds, the case with the fewest: "level_5, aims_d: 3
/// pairs of runs"; none where no case has too few and differs.
std::optional<std::string> too_few_seeds(const Comparison& comparison) {
  const ScoreChange* fewest = nullptr;
  for (const ScoreChange& each : comparison.changes) {
    const bool matters = std::abs(each.test.change) > each.floor;
    if (each.verdict != ChangeVerdict::kTooFew || !matters) continue;
    if (fewest == nullptr || each.pairs < fewest->pairs) fewest = &each;
  }
  if (fewest == nullptr) return std::nullopt;
  return fmt::format("{}, {}: {} pair{} of runs", fewest->scenario, fewest->estimator,
                     fewest->pairs, fewest->pairs == 1 ? "" : "s");
}

void print_comparison(const Comparison& comparison) {
  print_out("{}\n{}\n{}\n{}", to_text(change_table(comparison)), rule_text(comparison),
            summary_text(comparison), settings_text(comparison));
  for (const std::string& run : comparison.fails_now) print_out("FAILS NOW: {}\n", run);
  for (const std::string& run : comparison.fails_no_more) print_out("fails no more: {}\n", run);
  for (const std::string& run : comparison.partial) {
    print_out("success alone compared, the estimate lacks a part of the run: {}\n", run);
  }
  for (const std::string& run : comparison.only_before) print_out("only before: {}\n", run);
  for (const std::string& run : comparison.only_after) print_out("only after: {}\n", run);
  for (const std::string& run : comparison.invalid) print_out("INVALID RUN left out: {}\n", run);
}

int compare_command(const CompareArguments& arguments) {
  const auto before = read_results(arguments.before);
  if (!before) return refuse(kCompareName, before.error(), arguments.json);
  const auto after = read_results(arguments.after);
  if (!after) return refuse(kCompareName, after.error(), arguments.json);
  const Comparison comparison =
      with_settings(compare(*before, *after), JobStore(arguments.before).settings(),
                    JobStore(arguments.after).settings());
  if (arguments.json) {
    print_json(comparison_json(comparison, arguments.before, arguments.after));
  } else {
    print_comparison(comparison);
  }
  if (!arguments.shared.out.empty()) {
    const auto written =
        write_comparison(comparison, arguments.before, arguments.after, arguments.shared.out);
    if (!written) return bad_input(kCompareName, written.error());
  }
  if (!arguments.fail_on_worse) return kOk;
  if (count(comparison, ChangeVerdict::kWorse) > 0 || !comparison.fails_now.empty()) {
    return kExpectationFailed;
  }
  if (const auto found = too_few_seeds(comparison)) {
    return bad_input(kCompareName,
                     Error{fmt::format("--fail-on-worse: expected at least {} common seeds where "
                                       "results differ; {}: no change can be told from noise",
                                       kFewestPairs, *found)});
  }
  if (!comparison.not_compared.empty()) {
    return bad_input(kCompareName,
                     Error{fmt::format("--fail-on-worse: {} has no valid run of {} to compare with",
                                       arguments.after, comparison.not_compared.front())});
  }
  return kOk;
}

}  // namespace

void declare_compare(Command command) {
  auto arguments = std::make_shared<CompareArguments>();
  command.argument("before", arguments->before, "Folder of aims run or aims suite");
  command.argument("after", arguments->after, "Folder of aims run or aims suite");
  add_out(command, arguments->shared, "nowhere: the result is only printed");
  command.flag("--fail-on-worse", arguments->fail_on_worse,
               "Exit with 1 when a score got significantly worse or an estimator\n"
               "fails that did not, with 2 when results differ on too few seeds");
  add_json(command, arguments->json);
  command.footer(
      "Runs are paired by scenario, seed and estimator.\n"
      "Examples:\n"
      "  aims study compare out/before out/after\n"
      "  aims study compare out/suite out/eta5 --out out/eta5-compared --fail-on-worse");
  command.action([arguments] { return compare_command(*arguments); });
}

}  // namespace aims
