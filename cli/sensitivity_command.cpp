// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "bench/studies/sensitivity.hpp"
#include "bench/studies/suite_summary.hpp"
#include "cli/commands.hpp"
#include "cli/suite_options.hpp"
#include "cli/terminal.hpp"
#include "core/text.hpp"
#include "estimator/estimator_spec.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

struct SensitivityArguments {
  SharedOptions shared;
  std::vector<std::string> factors;
};

/// The factors of --factors; those of the study without any.
Result<std::vector<double>> factors_of(const std::vector<std::string>& texts) {
  if (texts.empty()) return SensitivityOptions().factors;
  std::vector<double> factors;
  for (const std::string& text : texts) {
    const double factor = number_from<double>(text).value_or(0.0);
    if (!(factor > 0.0 && factor < 1e6) || factor == 1.0) {
      return failure(fmt::format("--factors: expected numbers above 0, not 1, found '{}'", text));
    }
    factors.push_back(factor);
  }
  return factors;
}

Result<int> study_sensitivity(const SensitivityArguments& arguments) {
  SharedOptions shared = arguments.shared;
  const auto estimator = one_estimator(shared, "aims_d");
  if (!estimator) return tl::unexpected(estimator.error());
  const auto factors = factors_of(arguments.factors);
  if (!factors) return tl::unexpected(factors.error());
  shared.estimators.clear();  // the study sets its own
  std::vector<SettingVariant> variants;
  const auto adapt = [&](std::vector<ScenarioFile>& scenarios) -> Result<void> {
    auto set = set_setting_variants({*estimator, *factors}, scenarios);
    if (!set) return tl::unexpected(set.error());
    variants = std::move(*set);
    return {};
  };
  const auto suite = run_study(shared, {.seeds = {}, .outputs = {}, .adapt = adapt});
  if (!suite) return tl::unexpected(suite.error());
  const SettingSensitivity sensitivity = sensitivity_of(*suite, label_of(*estimator), variants);
  auto written = write_suite(*suite, shared.out);
  if (written) written = write_sensitivity(sensitivity, *suite, shared.out);
  if (!written) return tl::unexpected(written.error());
  print_out("{}\n", to_text(sensitivity_table(sensitivity)));
  print_outcome(*suite, shared);
  print_out("results: {}, sensitivity.json, sensitivity.csv\n",
            (fs::path(shared.out) / "sensitivity.md").string());
  return exit_code_of(*suite);
}

}  // namespace

void declare_sensitivity(Command command, const fs::path& scenarios) {
  auto arguments = std::make_shared<SensitivityArguments>();
  SharedOptions& shared = arguments->shared;
  shared.folder = scenarios.string();
  add_suite_options(command, shared, "out/sensitivity", "those of each scenario");
  add_estimators(command, shared, "aims_d; one");
  command.list("--factors", arguments->factors, "On each number, one setting at a time (0.5,2)");
  command.footer(
      std::string(kContinues) +
      "Examples:\n"
      "  aims study sensitivity random_corridor --seeds 1-10\n"
      "  aims study sensitivity severity_3 --estimators fast_lio2 --factors 0.25,0.5,2,4");
  command.action(
      [arguments] { return exit_code_of("study sensitivity", study_sensitivity(*arguments)); });
}

}  // namespace aims
