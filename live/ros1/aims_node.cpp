// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <string>

#include "live/live_options.hpp"
#include "live/live_session.hpp"
#include "live/ros1/ros1_transport.hpp"

namespace aims {
namespace {

constexpr const char* kProgram = "aims_node";

int main_of(int argc, char** argv) {
  auto command = parse_live_arguments(Ros1Transport::own_arguments(argc, argv), LiveNetwork::kRos1);
  if (!command) return report_bad_input(kProgram, command.error());
  if (!command->help.empty()) {
    print_line(command->help);
    return kLiveOk;
  }
  std::string problem;
  const auto transport = Ros1Transport::connect(argc, argv, kProgram, problem);
  if (!transport) return report_bad_input(kProgram, {problem});
  if (auto ok = apply_parameters(transport->parameters(), *command); !ok) {
    return report_bad_input(kProgram, ok.error());
  }
  return run_live(*transport, command->options, kProgram);
}

}  // namespace
}  // namespace aims

int main(int argc, char** argv) {
  try {
    return aims::main_of(argc, argv);
  } catch (const std::exception& error) {
    fmt::print(stderr, "aims_node: internal error: {}\n", error.what());
    return aims::kLiveInternal;
  }
}
