// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include "bench/scenario/catalogue.hpp"
#include "cli/commands.hpp"
#include "cli/json_output.hpp"
#include "cli/options.hpp"
#include "cli/terminal.hpp"

namespace aims {
namespace {

void print_entries(const std::vector<CatalogueEntry>& entries) {
  std::size_t width = 0;
  for (const CatalogueEntry& each : entries) width = std::max(width, each.name.size());
  for (const CatalogueEntry& each : entries) {
    const std::string tags =
        each.tags.empty() ? "" : fmt::format("  [{}]", fmt::join(each.tags, ", "));
    print_out("  {:<{}}  {}{}\n", each.name, width, each.description, tags);
  }
}

int list_command(const SharedOptions& shared, bool json) {
  std::error_code ignored;
  if (!std::filesystem::is_directory(shared.folder, ignored)) {
    return refuse("list", {"--folder " + shared.folder + ": expected a folder of scenarios"}, json);
  }
  const auto files = scenario_heads(shared.folder, shared.tags);
  if (!files) return refuse("list", files.error(), json);
  if (json) {
    print_json(list_json(shared.folder, *files));
    return kOk;
  }
  print_out("Scenarios in {} [tags]:\n", shared.folder);
  print_entries(scenario_catalogue(*files));
  const std::vector<Family> families = families_of(*files);
  if (!families.empty()) print_out("Families of scenarios, which differ in one quantity:\n");
  for (const Family& family : families) {
    print_out("  {:<16} [{}], {} scenarios: {}\n", family.name, family.level_unit,
              family.cases.size(), fmt::join(family.cases, ", "));
  }
  print_out("Robots, for robot.model:\n");
  print_entries(robot_catalogue());
  print_out("LiDAR models, for lidar.model:\n");
  print_entries(lidar_catalogue());
  print_out("Estimators:\n");
  print_entries(estimator_catalogue());
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
