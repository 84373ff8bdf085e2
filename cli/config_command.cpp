// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <memory>

#include "bench/scenario/catalogue.hpp"
#include "bench/scenario/scenario.hpp"
#include "cli/commands.hpp"
#include "cli/json_output.hpp"
#include "cli/options.hpp"
#include "cli/terminal.hpp"
#include "core/files/config_dump.hpp"
#include "estimator/estimator_spec.hpp"

namespace aims {
namespace {

struct ConfigArguments {
  SharedOptions shared;
  std::string estimator;
  bool plain = false;
  bool json = false;
};

void print_config(const std::string& name, const Fields& fields, const ConfigArguments& arguments) {
  if (arguments.json) {
    print_json(config_json(name, fields));
  } else {
    print_out("{}", arguments.plain ? dump_config(fields) : dump_annotated_config(fields));
  }
}

/// The settings of one estimator that have an effect, as a scenario has them.
Result<void> print_estimator(const Scenario& scenario, const ConfigArguments& arguments) {
  const auto spec = parse_estimator_spec(arguments.estimator);
  if (!spec) return tl::unexpected(spec.error());
  const auto config = config_with(*spec, scenario.estimators);
  if (!config) return tl::unexpected(config.error());
  Fields fields;
  fields.group_of("estimators." + spec->name, fields_of(**config));
  print_config(spec->name, fields, arguments);
  return {};
}

/// Names the option for an estimator that was given as a scenario.
Error with_hint(Error error, const SharedOptions& shared) {
  for (const CatalogueEntry& each : estimator_catalogue()) {
    if (each.name != shared.scenario) continue;
    error.message += fmt::format("; for the estimator: aims config --estimators {}", each.name);
  }
  return error;
}

int config_command(const ConfigArguments& arguments) {
  SharedOptions shared = arguments.shared;
  const bool one = !arguments.estimator.empty();
  if (one) shared.settings.push_back(run_setting(std::vector<std::string>{arguments.estimator}));
  auto scenario = shared.scenario.empty() ? default_scenario(shared.settings) : scenario_of(shared);
  if (!scenario) return refuse("config", with_hint(scenario.error(), shared), arguments.json);
  if (!one) {
    print_config(scenario->name, fields_of(*scenario), arguments);
  } else if (auto printed = print_estimator(*scenario, arguments); !printed) {
    return refuse("config", printed.error(), arguments.json);
  }
  return kOk;
}

}  // namespace

void declare_config(Command command, const std::filesystem::path& scenarios) {
  auto arguments = std::make_shared<ConfigArguments>();
  arguments->shared.folder = scenarios.string();
  add_scenario(command, arguments->shared, Presence::kOptional);
  add_folder(command, arguments->shared);
  add_settings(command, arguments->shared);
  command.option(
      "--estimators,--estimator", arguments->estimator,
      "Only the settings of this one that have an effect; NAME or\nNAME+key=value (all)");
  command.flag("--plain", arguments->plain, "Values without comments");
  add_json(command, arguments->json);
  command.exclude("--plain", "--json");
  command.footer(
      "Without a scenario, the defaults. The output is a scenario file.\n"
      "Examples:\n"
      "  aims config corridor --set lidar.range_max=30\n"
      "  aims config --estimators aims_d");
  command.action([arguments] { return config_command(*arguments); });
}

}  // namespace aims
