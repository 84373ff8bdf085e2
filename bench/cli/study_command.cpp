// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bench/cli/commands.hpp"
#include "bench/cli/json_output.hpp"
#include "bench/cli/options.hpp"
#include "bench/cli/suite_options.hpp"
#include "bench/cli/terminal.hpp"
#include "bench/studies/ablation.hpp"
#include "bench/studies/comparison.hpp"
#include "bench/studies/consistency_study.hpp"
#include "bench/studies/detector_summary.hpp"
#include "bench/studies/detectors.hpp"
#include "bench/studies/sensitivity.hpp"
#include "bench/studies/suite_summary.hpp"
#include "estimator/estimator_spec.hpp"
#include "render/results/consistency_pictures.hpp"
#include "render/results/detector_pictures.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

constexpr const char* kContinues =
    "The same command again continues, and runs only what is missing or has changed.\n";

/// The one estimator of --estimators; `absent` without it.
Result<std::string> one_estimator(const SharedOptions& options, const std::string& absent) {
  const auto specs = joined_specs(options.estimators);
  if (specs.empty()) return absent;
  if (specs.size() == 1) return specs.front();
  return failure(fmt::format("--estimators: expected one estimator, found {}", specs.size()));
}

std::vector<std::uint64_t> first_seeds(std::uint64_t count) {
  std::vector<std::uint64_t> seeds;
  for (std::uint64_t seed = 1; seed <= count; ++seed) seeds.push_back(seed);
  return seeds;
}

struct AblationArguments {
  SharedOptions shared;
  std::vector<std::string> groups;
  std::vector<std::string> baselines;
};

void print_ablation(const Ablation& ablation) {
  for (const AblationCase& each : ablation.cases) {
    if (each.rows.empty()) continue;
    print_out("{}, median over {} seeds (ratio to {})\n{}\n", each.scenario, each.rows.front().runs,
              ablation.complete, to_text(case_table(each)));
  }
  print_out("Geometric mean of the ratios over scenarios\n{}\n", to_text(effect_table(ablation)));
}

int ablation_command(const AblationArguments& arguments) {
  constexpr const char* kName = "study ablation";
  SharedOptions shared = arguments.shared;
  const auto estimator = one_estimator(shared, "aims_d");
  if (!estimator) return bad_input(kName, estimator.error());
  shared.estimators.clear();  // the study sets its own
  const auto options = suite_options(shared, {});
  if (!options) return bad_input(kName, options.error());
  auto scenarios = study_scenarios(shared);
  if (!scenarios) return bad_input(kName, scenarios.error());
  const AblationOptions variants = {*estimator, arguments.groups,
                                    joined_specs(arguments.baselines)};
  if (auto set = set_variants(variants, *scenarios); !set) return bad_input(kName, set.error());
  const auto suite = run_with_display(std::move(*scenarios), *options, shared.quiet);
  if (!suite) return bad_input(kName, suite.error());
  const Ablation ablation = ablation_of(*suite, label_of(*estimator));
  auto written = write_suite(*suite, shared.out);
  if (written) written = write_ablation(ablation, *suite, shared.out);
  if (!written) return bad_input(kName, written.error());
  print_ablation(ablation);
  print_outcome(*suite, shared);
  print_out("results: {}, ablation.json, ablation.csv\n",
            (fs::path(shared.out) / "ablation.md").string());
  return exit_code_of(*suite);
}

void declare_ablation(Command command, const fs::path& scenarios) {
  auto arguments = std::make_shared<AblationArguments>();
  SharedOptions& shared = arguments->shared;
  shared.folder = scenarios.string();
  add_suite_options(command, shared, "out/ablation", "those of each scenario");
  add_estimators(command, shared, "aims_d; one");
  command.list("--groups", arguments->groups,
               "Groups of keys below estimator. whose switches are inverted,\n"
               "one at a time (switches off each part that is on)");
  command.list("--baselines", arguments->baselines,
               "Estimators to compare with, e.g. lio,tfs_clean");
  command.footer(std::string(kContinues) +
                 "Examples:\n"
                 "  aims study ablation severity_3 severity_8 --seeds 1-3 --out out/ablation\n"
                 "  aims study ablation --tags severity --seeds 1-5 --baselines lio,tfs_clean\n"
                 "  aims study ablation severity_5 --groups leg_states");
  command.action([arguments] { return ablation_command(*arguments); });
}

struct SensitivityArguments {
  SharedOptions shared;
  std::vector<std::string> factors;
};

/// The factors of --factors; those of the study without any.
Result<std::vector<double>> factors_of(const std::vector<std::string>& texts) {
  if (texts.empty()) return SensitivityOptions().factors;
  std::vector<double> factors;
  for (const std::string& text : texts) {
    double factor = 0.0;
    const char* end = text.data() + text.size();
    const auto [at, error] = std::from_chars(text.data(), end, factor);
    if (error != std::errc() || at != end || !(factor > 0.0 && factor < 1e6) || factor == 1.0) {
      return failure(fmt::format("--factors: expected numbers above 0, not 1, found '{}'", text));
    }
    factors.push_back(factor);
  }
  return factors;
}

int sensitivity_command(const SensitivityArguments& arguments) {
  constexpr const char* kName = "study sensitivity";
  SharedOptions shared = arguments.shared;
  const auto estimator = one_estimator(shared, "aims_d");
  if (!estimator) return bad_input(kName, estimator.error());
  shared.estimators.clear();  // the study sets its own
  const auto options = suite_options(shared, {});
  if (!options) return bad_input(kName, options.error());
  auto scenarios = study_scenarios(shared);
  if (!scenarios) return bad_input(kName, scenarios.error());
  const auto factors = factors_of(arguments.factors);
  if (!factors) return bad_input(kName, factors.error());
  const auto variants = set_setting_variants({*estimator, *factors}, *scenarios);
  if (!variants) return bad_input(kName, variants.error());
  const auto suite = run_with_display(std::move(*scenarios), *options, shared.quiet);
  if (!suite) return bad_input(kName, suite.error());
  const SettingSensitivity sensitivity = sensitivity_of(*suite, label_of(*estimator), *variants);
  auto written = write_suite(*suite, shared.out);
  if (written) written = write_sensitivity(sensitivity, *suite, shared.out);
  if (!written) return bad_input(kName, written.error());
  print_out("{}\n", to_text(sensitivity_table(sensitivity)));
  print_outcome(*suite, shared);
  print_out("results: {}, sensitivity.json, sensitivity.csv\n",
            (fs::path(shared.out) / "sensitivity.md").string());
  return exit_code_of(*suite);
}

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
  command.action([arguments] { return sensitivity_command(*arguments); });
}

Result<void> write_results(const Suite& suite, const ConsistencyStudy& study, const fs::path& out) {
  auto written = write_suite(suite, out);
  if (written) written = write_consistency(study, suite, out);
  return written ? draw_consistency(study, out) : written;
}

int consistency_command(const SharedOptions& shared) {
  constexpr const char* kName = "study consistency";
  auto options = suite_options(shared, first_seeds(10));
  if (!options) return bad_input(kName, options.error());
  options->jobs.outputs.weak_axis = true;
  auto scenarios = study_scenarios(shared);
  if (!scenarios) return bad_input(kName, scenarios.error());
  const auto suite = run_with_display(std::move(*scenarios), *options, shared.quiet);
  if (!suite) return bad_input(kName, suite.error());
  const auto study = consistency_study(*suite, shared.out);
  if (!study) return bad_input(kName, study.error());
  if (auto written = write_results(*suite, *study, shared.out); !written) {
    return bad_input(kName, written.error());
  }
  print_out("Along the weak axis, over the sequence\n{}\n", to_text(consistency_table(*study)));
  print_out("At the end of the sequence, root mean square over seeds [m]\n{}\n",
            to_text(end_table(*study)));
  print_outcome(*suite, shared);
  print_out("results: {}, consistency.json, consistency.csv, pictures\n",
            (fs::path(shared.out) / "consistency.md").string());
  return exit_code_of(*suite);
}

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
  command.action([shared] { return consistency_command(*shared); });
}

int detectors_command(const SharedOptions& given) {
  constexpr const char* kName = "study detectors";
  SharedOptions shared = given;
  const auto estimator = one_estimator(shared, "aims");
  if (!estimator) return bad_input(kName, estimator.error());
  shared.estimators = {*estimator};
  auto options = suite_options(shared, first_seeds(5));
  if (!options) return bad_input(kName, options.error());
  options->jobs.outputs.trajectories = true;
  auto scenarios = study_scenarios(shared);
  if (!scenarios) return bad_input(kName, scenarios.error());
  const auto suite = run_with_display(std::move(*scenarios), *options, shared.quiet);
  if (!suite) return bad_input(kName, suite.error());
  const auto study = detector_study(*suite, shared.out);
  if (!study) return bad_input(kName, study.error());
  auto written = write_detectors(*study, shared.out);
  if (written) written = draw_detectors(*study, shared.out);
  if (!written) return bad_input(kName, written.error());
  print_out(
      "{} runs; AUC with 95 % interval over runs, detection rate at {:.0f} % false alarms, "
      "median delay, onsets missed\n{}\n",
      study->runs.size(), 100.0 * kFalseAlarms, to_text(detector_table(study->scores)));
  for (const std::string& warning : study->warnings) print_out("note: {}\n", warning);
  print_outcome(*suite, shared);
  print_out("results: {}\n", (fs::path(shared.out) / "detectors.md").string());
  return exit_code_of(*suite);
}

void declare_detectors(Command command, const fs::path& scenarios) {
  auto shared = std::make_shared<SharedOptions>();
  shared->folder = scenarios.string();
  add_suite_options(command, *shared, "out/detectors", "1-5");
  add_estimators(command, *shared, "aims; one");
  command.footer(std::string(kContinues) +
                 "Example:\n"
                 "  aims study detectors corridor corridor_smooth --seeds 1-5 --out out/detectors");
  command.action([shared] { return detectors_command(*shared); });
}

struct CompareArguments {
  std::string before;
  std::string after;
  SharedOptions shared;
  bool fail_on_worse = false;
  bool json = false;
};

/// The largest number of common seeds, when results differ and no score has enough of them.
std::optional<std::size_t> too_few_seeds(const Comparison& comparison) {
  std::size_t most = 0;
  for (const ScoreChange& each : comparison.changes) most = std::max(most, each.pairs);
  const bool differ = count(comparison, ChangeVerdict::kTooFew) > 0;
  return differ && most < kFewestPairs ? std::optional(most) : std::nullopt;
}

void print_comparison(const Comparison& comparison) {
  print_out("{}\n{}\n{}\n", to_text(change_table(comparison)), rule_text(comparison),
            summary_text(comparison));
  for (const std::string& run : comparison.only_before) print_out("only before: {}\n", run);
  for (const std::string& run : comparison.only_after) print_out("only after: {}\n", run);
  for (const std::string& run : comparison.invalid) print_out("INVALID RUN left out: {}\n", run);
}

int compare_command(const CompareArguments& arguments) {
  constexpr const char* kName = "study compare";
  const auto before = read_results(arguments.before);
  if (!before) return bad_input(kName, before.error());
  const auto after = read_results(arguments.after);
  if (!after) return bad_input(kName, after.error());
  const Comparison comparison = compare(*before, *after);
  if (arguments.json) {
    print_json(comparison_json(comparison, arguments.before, arguments.after));
  } else {
    print_comparison(comparison);
  }
  if (!arguments.shared.out.empty()) {
    const auto written =
        write_comparison(comparison, arguments.before, arguments.after, arguments.shared.out);
    if (!written) return bad_input(kName, written.error());
  }
  if (!arguments.fail_on_worse) return kOk;
  if (count(comparison, ChangeVerdict::kWorse) > 0) return kExpectationFailed;
  if (const auto seeds = too_few_seeds(comparison)) {
    return bad_input(kName, Error{fmt::format("--fail-on-worse: expected at least {} common seeds, "
                                              "found at most {}: no change can be told from noise",
                                              kFewestPairs, *seeds)});
  }
  return kOk;
}

void declare_compare(Command command) {
  auto arguments = std::make_shared<CompareArguments>();
  command.argument("before", arguments->before, "Folder of aims run or aims suite");
  command.argument("after", arguments->after, "Folder of aims run or aims suite");
  add_out(command, arguments->shared, "nowhere: the result is only printed");
  command.flag("--fail-on-worse", arguments->fail_on_worse,
               "Exit with 1 when a score got significantly worse, with 2\n"
               "when there are too few common seeds");
  add_json(command, arguments->json);
  command.footer(
      "Runs are paired by scenario, seed and estimator.\n"
      "Examples:\n"
      "  aims study compare out/before out/after\n"
      "  aims study compare out/suite out/eta5 --out out/eta5-compared --fail-on-worse");
  command.action([arguments] { return compare_command(*arguments); });
}

}  // namespace

void declare_study(Command command, const fs::path& scenarios) {
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
  declare_fidelity(command.subcommand("fidelity", "The simulated sensors against real ones"),
                   scenarios);
  declare_fidelity_baselines(
      command.subcommand("fidelity-baselines", "Baselines against the published systems"),
      scenarios);
  declare_compare(
      command.subcommand("compare", "Scores that got better or worse between two folders"));
  declare_groups(command.subcommand("groups", "Scores by a quantity that the seeds drew"));
  declare_paper(command.subcommand("paper", "The paper's tables with every compared system"),
                scenarios);
  declare_order(command.subcommand(
      "order", "Conditions under which adaptive weights help and the paper's order holds"));
  command.footer(
      "Examples:\n"
      "  aims study ablation severity_3 severity_8 --seeds 1-3\n"
      "  aims study compare out/before out/after");
}

}  // namespace aims
