// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>

#include "app/commands.hpp"
#include "app/exit_code.hpp"
#include "harness/catalogue.hpp"

namespace aims {
namespace {

bool tagged(const CatalogueEntry& entry, const std::string& tag) {
  return tag.empty() || std::find(entry.tags.begin(), entry.tags.end(), tag) != entry.tags.end();
}

void print_entry(const CatalogueEntry& entry) {
  const std::string tags =
      entry.tags.empty() ? "" : fmt::format("  [{}]", fmt::join(entry.tags, ", "));
  fmt::print("  {:<16} {}{}\n", entry.name, entry.description, tags);
}

}  // namespace

void add_list_command(CLI::App& app, const std::filesystem::path& scenario_folder, int& exit_code) {
  auto* command = app.add_subcommand("list", "Scenarios and estimators, a line each");
  auto folder = std::make_shared<std::string>(scenario_folder.string());
  auto tag = std::make_shared<std::string>();
  command->add_option("--scenarios", *folder, "Folder of scenarios");
  command->add_option("--tag", *tag, "Only scenarios with this tag");
  command->footer("Example: aims list --tag paper");
  command->callback([folder, tag, &exit_code] {
    fmt::print("Scenarios in {}:\n", *folder);
    for (const CatalogueEntry& entry : scenario_catalogue(*folder)) {
      if (tagged(entry, *tag)) print_entry(entry);
    }
    fmt::print("Estimators:\n");
    for (const CatalogueEntry& entry : estimator_catalogue()) print_entry(entry);
    exit_code = kOk;
  });
}

}  // namespace aims
