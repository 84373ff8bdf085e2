// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "bench/cli/commands.hpp"
#include "bench/cli/exit_code.hpp"
#include "bench/run/catalogue.hpp"

namespace aims {
namespace {

void print_entry(const CatalogueEntry& entry) {
  const std::string tags =
      entry.tags.empty() ? "" : fmt::format("  [{}]", fmt::join(entry.tags, ", "));
  fmt::print("  {:<16} {}{}\n", entry.name, entry.description, tags);
}

int print_list(const std::string& folder, const std::vector<std::string>& tags) {
  const auto files = scenarios_in(folder, tags);
  if (!files) {
    fmt::print(stderr, "aims list: {}\n", files.error().message);
    return kBadInput;
  }
  fmt::print("Scenarios in {}:\n", folder);
  for (const CatalogueEntry& entry : scenario_catalogue(*files)) print_entry(entry);
  const std::vector<Family> families = families_of(*files);
  if (!families.empty()) fmt::print("Families, by level:\n");
  for (const Family& family : families) {
    fmt::print("  {:<16} [{}], {} cases: {}\n", family.name, family.level_unit, family.cases.size(),
               fmt::join(family.cases, ", "));
  }
  fmt::print("Estimators:\n");
  for (const CatalogueEntry& entry : estimator_catalogue()) print_entry(entry);
  return kOk;
}

}  // namespace

void add_list_command(CLI::App& app, const std::filesystem::path& scenario_folder, int& exit_code) {
  auto* command = app.add_subcommand("list", "Scenarios, families and estimators, a line each");
  auto folder = std::make_shared<std::string>(scenario_folder.string());
  auto tags = std::make_shared<std::vector<std::string>>();
  command->add_option("--folder", *folder, "Folder of scenarios, searched with those in it");
  command
      ->add_option("--tags", *tags, "Only scenarios with any of these tags, e.g. stress,severity")
      ->delimiter(',');
  command->footer("Examples:\n  aims list\n  aims list --tags stress,severity");
  command->callback([folder, tags, &exit_code] { exit_code = print_list(*folder, *tags); });
}

}  // namespace aims
