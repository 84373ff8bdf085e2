// SPDX-License-Identifier: BSD-3-Clause
#include <memory>

#include "bench/cli/commands.hpp"
#include "bench/cli/options.hpp"
#include "bench/cli/terminal.hpp"
#include "bench/run/scenario.hpp"
#include "core/files/config_dump.hpp"
#include "estimator/estimator_spec.hpp"

namespace aims {
namespace {

/// The settings of one estimator that have an effect, as a scenario has them.
Result<std::string> estimator_text(const Scenario& scenario, const std::string& text, bool plain) {
  const auto spec = parse_estimator_spec(text);
  if (!spec) return tl::unexpected(spec.error());
  const auto config = config_with(*spec, scenario.estimators);
  if (!config) return tl::unexpected(config.error());
  Fields fields;
  fields.group_of("estimators." + spec->name, fields_of(**config));
  return plain ? dump_config(fields) : dump_annotated_config(fields);
}

int config_command(SharedOptions shared, const std::string& estimator, bool plain) {
  if (!estimator.empty()) {
    shared.settings.push_back(run_setting(std::vector<std::string>{estimator}));
  }
  const auto scenario =
      shared.scenario.empty() ? default_scenario(shared.settings) : scenario_of(shared);
  if (!scenario) return bad_input("config", scenario.error());
  const auto text = estimator.empty() ? config_text(*scenario, !plain)
                                      : estimator_text(*scenario, estimator, plain);
  if (!text) return bad_input("config", text.error());
  print_out("{}", *text);
  return kOk;
}

}  // namespace

void declare_config(Command command, const std::filesystem::path& scenarios) {
  struct Arguments {
    SharedOptions shared;
    std::string estimator;
    bool plain = false;
  };
  auto arguments = std::make_shared<Arguments>();
  arguments->shared.folder = scenarios.string();
  add_scenario(command, arguments->shared, Presence::kOptional);
  add_folder(command, arguments->shared);
  add_settings(command, arguments->shared);
  command.option("--estimator", arguments->estimator,
                 "Only its settings that have an effect; NAME or\nNAME+key=value (all)");
  command.flag("--plain", arguments->plain, "Values without comments");
  command.footer(
      "Without a scenario, the defaults. The output is a scenario file.\n"
      "Examples:\n"
      "  aims config corridor --set lidar.range_max=30\n"
      "  aims config --estimator aims_d");
  command.action([arguments] {
    return config_command(arguments->shared, arguments->estimator, arguments->plain);
  });
}

}  // namespace aims
