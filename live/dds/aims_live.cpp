// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "live/dds/dds_transport.hpp"
#include "live/dds/discovery.hpp"
#include "live/live_options.hpp"
#include "live/live_session.hpp"

namespace aims {
namespace {

constexpr const char* kProgram = "aims_live";

int main_of(int argc, char** argv) {
  const auto command =
      parse_live_arguments(std::vector<std::string>(argv + 1, argv + argc), LiveNetwork::kDds);
  if (!command) return report_bad_input(kProgram, command.error());
  if (!command->help.empty()) {
    print_line(command->help);
    return kLiveOk;
  }
  const LiveOptions& options = command->options;
  DdsOptions dds;
  dds.node = options.node;
  dds.source_time = options.source_time;
  if (options.domain) {
    dds.domain = *options.domain;
  } else {
    const auto domain = default_domain();
    if (!domain) return report_bad_input(kProgram, domain.error());
    dds.domain = *domain;
  }
  const auto transport = DdsTransport::connect(dds);
  if (!transport) return report_bad_input(kProgram, transport.error());
  return run_live(**transport, options, kProgram);
}

}  // namespace
}  // namespace aims

int main(int argc, char** argv) {
  try {
    return aims::main_of(argc, argv);
  } catch (const std::exception& error) {
    fmt::print(stderr, "aims_live: internal error: {}\n", error.what());
    return aims::kLiveInternal;
  }
}
