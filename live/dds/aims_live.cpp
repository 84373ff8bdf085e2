// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <chrono>
#include <string>
#include <thread>

#include "core/stopwatch.hpp"
#include "live/dds/dds_options.hpp"
#include "live/live_session.hpp"
#include "live/program.hpp"
#include "recordings/messages/message_encoding.hpp"
#include "recordings/messages/message_types.hpp"

namespace aims {
namespace {

constexpr double kPatience = 5.0;                       ///< for the node to be found [s]
constexpr auto kPoll = std::chrono::milliseconds(200);  ///< also of discovery on both sides

/// Sends a command to the node of the options' name.
Result<void> tell(DdsTransport& transport, const std::string& text) {
  const auto publisher = transport.advertise("~command", string_type(), false);
  const Stopwatch since;
  while (!transport.heard(publisher)) {
    if (since.seconds() > kPatience || !transport.running()) {
      return failure(fmt::format("nobody listens to {}", transport.resolved("~command")));
    }
    std::this_thread::sleep_for(kPoll);
  }
  std::this_thread::sleep_for(kPoll);
  transport.publish(publisher, string_message(text, Serialization::kCdr).view());
  transport.wait_for_subscribers(kPatience);
  std::this_thread::sleep_for(kPoll);
  return {};
}

int main_of(int argc, char** argv) {
  CLI::App app(
      "Estimates a robot's motion live from ROS 2 topics and publishes it on /aims/odometry.\n"
      "Needs no ROS: it speaks DDS.",
      "aims_live");
  app.footer(
      "CYCLONEDDS_URI chooses the interfaces. Exit codes: 0 ok, 2 bad usage, configuration or "
      "topics.");
  LiveOptions options;
  DdsOptions dds;
  std::string command;
  add_live_options(app, options);
  add_domain_option(app, dds);
  add_node_option(app, dds, "Namespace of the published topics (aims)");
  app.add_flag("--source-time,--source_time", options.source_time,
               "Arrivals are the publishers' times of sending: for aims_play at another pace");
  app.add_option("--tell", command,
                 "Send a command to the running node of that name and end: save_map, calibrate "
                 "(standing), reset")
      ->check(CLI::IsMember({"save_map", "calibrate", "reset"}));
  return run_program(app, {argv + 1, argv + argc}, [&]() -> Result<void> {
    dds.source_time = options.source_time;
    const auto transport = DdsTransport::connect(dds);
    if (!transport) return tl::unexpected(transport.error());
    return command.empty() ? run_live(**transport, options) : tell(**transport, command);
  });
}

}  // namespace
}  // namespace aims

int main(int argc, char** argv) { return aims::main_of(argc, argv); }
