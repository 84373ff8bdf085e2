// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "bench/scenario/catalogue.hpp"
#include "cli/commands.hpp"
#include "cli/json_output.hpp"
#include "cli/options.hpp"
#include "cli/terminal.hpp"

namespace aims {
namespace {

void print_entry(const CatalogueEntry& entry) {
  const std::string tags =
      entry.tags.empty() ? "" : fmt::format("  [{}]", fmt::join(entry.tags, ", "));
  print_out("  {:<20} {}{}\n", entry.name, entry.description, tags);
}

int list_command(const SharedOptions& shared, bool json) {
  const auto files = scenario_heads(shared.folder, shared.tags);
  if (!files) return refuse("list", files.error(), json);
  if (json) {
    print_json(list_json(shared.folder, *files));
    return kOk;
  }
  print_out("Scenarios in {} [tags]:\n", shared.folder);
  for (const CatalogueEntry& entry : scenario_catalogue(*files)) print_entry(entry);
  const std::vector<Family> families = families_of(*files);
  if (!families.empty()) print_out("Families of scenarios, which differ in one quantity:\n");
  for (const Family& family : families) {
    print_out("  {:<16} [{}], {} scenarios: {}\n", family.name, family.level_unit,
              family.cases.size(), fmt::join(family.cases, ", "));
  }
  print_out("Robots, for robot.model:\n");
  for (const CatalogueEntry& entry : robot_catalogue()) print_entry(entry);
  print_out("LiDAR models, for lidar.model:\n");
  for (const CatalogueEntry& entry : lidar_catalogue()) print_entry(entry);
  print_out("Estimators:\n");
  for (const CatalogueEntry& entry : estimator_catalogue()) print_entry(entry);
  return kOk;
}

}  // namespace

void declare_list(Command command, const std::filesystem::path& scenarios) {
  struct Arguments {
    SharedOptions shared;
    bool json = false;
  };
  auto arguments = std::make_shared<Arguments>();
  arguments->shared.folder = scenarios.string();
  add_tags(command, arguments->shared);
  add_folder(command, arguments->shared);
  add_json(command, arguments->json);
  command.footer("Examples:\n  aims list\n  aims list --tags stress,severity");
  command.action([arguments] { return list_command(arguments->shared, arguments->json); });
}

}  // namespace aims
