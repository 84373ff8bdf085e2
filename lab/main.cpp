// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <filesystem>

#include "bench/scenario/catalogue.hpp"
#include "cli/command.hpp"
#include "lab/commands.hpp"

namespace {

constexpr std::array kCommands = {
    aims::CommandEntry{"fidelity", "The simulated sensors against real ones",
                       aims::declare_fidelity},
    aims::CommandEntry{"fidelity-baselines", "Baselines against the published systems",
                       aims::declare_fidelity_baselines},
    aims::CommandEntry{"order",
                       "Conditions under which adaptive weights help and the paper's order holds",
                       aims::declare_order},
    aims::CommandEntry{"weak", "What holds a run along its weak axis, by source",
                       aims::declare_weak},
};

}  // namespace

int main(int argc, char** argv) {
  const auto scenarios =
      aims::default_scenario_folder(std::filesystem::read_symlink("/proc/self/exe"));
  return aims::run_program({"aims_lab",
                            "aims_lab: studies for those who change the project.",
                            "Examples:\n  aims_lab fidelity",
                            "aims_lab " AIMS_VERSION,
                            kCommands,
                            {},
                            scenarios},
                           argc, argv);
}
