// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "core/stopwatch.hpp"
#include "live/dds/dds_transport.hpp"
#include "live/dds/discovery.hpp"
#include "live/live_options.hpp"
#include "live/live_session.hpp"
#include "live/program.hpp"
#include "recordings/messages/message_encoding.hpp"

namespace aims {
namespace {

constexpr const char* kProgram = "aims_live";

constexpr double kPatience = 5.0;                       ///< for the node to be found [s]
constexpr auto kPoll = std::chrono::milliseconds(200);  ///< also of discovery on both sides

/// Sends a command to the node of the options' name.
Result<void> tell(DdsTransport& transport, const std::string& text) {
  const auto publisher = transport.advertise(
      {.topic = "~command", .type = "std_msgs/String", .md5 = {}, .definition = {}, .cdr = true});
  const Stopwatch since;
  while (!transport.heard(publisher)) {
    if (since.seconds() > kPatience || !transport.running()) {
      return failure(fmt::format("nobody listens to {}", transport.resolved("~command")));
    }
    std::this_thread::sleep_for(kPoll);
  }
  std::this_thread::sleep_for(kPoll);
  const MessageBytes message = string_message(text, Serialization::kCdr);
  transport.publish(publisher, message.view().data(), message.view().size());
  transport.wait_for_subscribers(kPatience);
  std::this_thread::sleep_for(kPoll);
  return {};
}

int main_of(int argc, char** argv) {
  const auto command =
      parse_live_arguments(std::vector<std::string>(argv + 1, argv + argc), LiveNetwork::kDds);
  if (!command) return report_bad_input(kProgram, command.error().message);
  if (!command->help.empty()) {
    print_line(command->help);
    return kLiveOk;
  }
  const LiveOptions& options = command->options;
  DdsOptions dds{.node = options.node, .source_time = options.source_time};
  const Result<std::uint32_t> domain = options.domain ? *options.domain : default_domain();
  if (!domain) return report_bad_input(kProgram, domain.error().message);
  dds.domain = *domain;
  const auto transport = DdsTransport::connect(dds);
  if (!transport) return report_bad_input(kProgram, transport.error().message);
  const auto done =
      options.tell.empty() ? run_live(**transport, options) : tell(**transport, options.tell);
  return done ? kLiveOk : report_bad_input(kProgram, done.error().message);
}

}  // namespace
}  // namespace aims

int main(int argc, char** argv) {
  return aims::guarded_main(aims::kProgram, [&] { return aims::main_of(argc, argv); });
}
