// SPDX-License-Identifier: BSD-3-Clause
#include <memory>
#include <string>

#include "bench/scenario/catalogue.hpp"
#include "bench/scenario/scenario.hpp"
#include "cli/commands.hpp"
#include "cli/completion.hpp"
#include "cli/options.hpp"
#include "cli/terminal.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

int print_scenarios(const fs::path& folder) {
  const auto files = scenario_files(folder);
  if (!files) return bad_input("completion", files.error());
  for (const fs::path& file : *files) print_out("{}\n", file.stem().string());
  return kOk;
}

int print_estimators() {
  for (const CatalogueEntry& each : estimator_catalogue()) print_out("{}\n", each.name);
  return kOk;
}

/// What --set takes: "lidar.range_sigma=".
int print_keys() {
  Scenario scenario;
  for (const Parameter& each : fields_of(scenario).parameters()) print_out("{}=\n", each.key);
  return kOk;
}

}  // namespace

void declare_completion(Command command, const fs::path& scenarios) {
  auto what = std::make_shared<std::string>();
  command.choice("what", *what, {"bash", "zsh", "scenarios", "estimators", "keys"},
                 "The script of a shell, or the names that it asks for", Presence::kRequired);
  command.footer(
      "Installed packages have the scripts in place. Elsewhere:\n"
      "  source <(aims completion bash)\n"
      "  aims completion zsh > ~/.zfunc/_aims    # a folder of fpath");
  command.action([what, command, scenarios] {
    if (*what == "scenarios") return print_scenarios(scenarios);
    if (*what == "estimators") return print_estimators();
    if (*what == "keys") return print_keys();
    const CLI::App& program = command.program();
    print_out("{}", *what == "bash" ? bash_completion(program) : zsh_completion(program));
    return static_cast<int>(kOk);
  });
}

}  // namespace aims
