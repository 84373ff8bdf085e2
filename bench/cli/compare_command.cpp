// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <memory>
#include <string>

#include "bench/cli/commands.hpp"
#include "bench/cli/exit_code.hpp"
#include "bench/cli/options.hpp"
#include "bench/studies/comparison.hpp"

namespace aims {
namespace {

struct CompareArguments {
  std::string before;
  std::string after;
  std::string out;
  bool fail_on_worse = false;
};

void print_changes(const char* title, const Comparison& comparison, ChangeVerdict verdict) {
  if (count(comparison, verdict) == 0) return;
  fmt::print("\n{}\n{}", title, to_text(change_table(comparison, verdict)));
}

void print_comparison(const Comparison& comparison) {
  fmt::print("{}\n", summary_text(comparison));
  print_changes("worse", comparison, ChangeVerdict::kWorse);
  print_changes("better", comparison, ChangeVerdict::kBetter);
  print_changes("different, on one seed", comparison, ChangeVerdict::kUnknown);
  for (const std::string& unit : comparison.only_before) fmt::print("only before: {}\n", unit);
  for (const std::string& unit : comparison.only_after) fmt::print("only after: {}\n", unit);
}

int compare_command(const CompareArguments& arguments) {
  const auto before = read_results(arguments.before);
  if (!before) return bad_input("compare", before.error());
  const auto after = read_results(arguments.after);
  if (!after) return bad_input("compare", after.error());
  const Comparison comparison = compare(*before, *after);
  print_comparison(comparison);
  if (!arguments.out.empty()) {
    const auto written =
        write_comparison(comparison, arguments.before, arguments.after, arguments.out);
    if (!written) return bad_input("compare", written.error());
  }
  const bool worse = count(comparison, ChangeVerdict::kWorse) > 0;
  return arguments.fail_on_worse && worse ? kGateFailed : kOk;
}

}  // namespace

void add_compare_command(CLI::App& app, int& exit_code) {
  auto* command = app.add_subcommand("compare", "What got better and worse between two results");
  auto arguments = std::make_shared<CompareArguments>();
  command->add_option("before", arguments->before, "Folder of aims suite or aims run")->required();
  command->add_option("after", arguments->after, "Folder of aims suite or aims run")->required();
  command->add_option("--out", arguments->out, "Folder for compare.json and compare.md");
  command->add_flag("--fail-on-worse", arguments->fail_on_worse,
                    "Exit with 1 when anything got worse beyond noise");
  command->footer(
      "Runs are paired by scenario, seed and estimator. Examples:\n"
      "  aims compare out/before out/after\n"
      "  aims compare out/suite out/eta5 --out out/eta5-compared --fail-on-worse");
  command->callback([arguments, &exit_code] { exit_code = compare_command(*arguments); });
}

}  // namespace aims
