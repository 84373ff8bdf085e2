// SPDX-License-Identifier: BSD-3-Clause
#include <string>

#include "live/live_options.hpp"
#include "live/live_session.hpp"
#include "live/program.hpp"
#include "live/ros1/ros1_transport.hpp"

namespace aims {
namespace {

constexpr const char* kProgram = "aims_node";

int main_of(int argc, char** argv) {
  const auto command =
      parse_live_arguments(Ros1Transport::own_arguments(argc, argv), LiveNetwork::kRos1);
  if (!command) return report_bad_input(kProgram, command.error().message);
  if (!command->help.empty()) {
    print_line(command->help);
    return kLiveOk;
  }
  std::string problem;
  const auto transport = Ros1Transport::connect(argc, argv, kProgram, problem);
  if (!transport) return report_bad_input(kProgram, problem);
  const auto done = run_live(*transport, command->options);
  return done ? kLiveOk : report_bad_input(kProgram, done.error().message);
}

}  // namespace
}  // namespace aims

int main(int argc, char** argv) {
  return aims::guarded_main(aims::kProgram, [&] { return aims::main_of(argc, argv); });
}
