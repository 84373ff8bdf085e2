// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <string>

#include "live/dds/dds_options.hpp"
#include "live/program.hpp"
#include "live/watch/watch_server.hpp"
#include "live/watch/watch_state.hpp"
#include "recordings/messages/message_types.hpp"

namespace aims {
namespace {

constexpr double kPoll = 0.2;  ///< [s]

Result<void> watch(const DdsOptions& dds, const std::string& address, std::uint16_t port) {
  if (watch_page().empty()) {
    return failure("built without its page: build again where npm works");
  }
  const auto connected = DdsTransport::connect(dds);
  if (!connected) return tl::unexpected(connected.error());
  DdsTransport& transport = **connected;
  transport.limit_wait(kSecond);
  transport.subscribe("~odometry", odometry_type().name);
  transport.subscribe("~cloud", point_cloud_type().name);
  transport.subscribe("/diagnostics", diagnostics_type().name);
  const std::string topic = transport.resolved("~odometry");
  WatchState state(topic);
  const auto server = WatchServer::start(address, port, state);
  if (!server) return tl::unexpected(server.error());
  print_line(fmt::format("watching {}: http://{}:{}/", topic, address, (*server)->port()));
  while (transport.running()) {
    if (const auto message = transport.wait(kPoll)) state.take(*message);
  }
  return {};
}

}  // namespace
}  // namespace aims

int main(int argc, char** argv) {
  using namespace aims;
  CLI::App app("Shows a live estimate in a browser.", "aims_watch");
  app.footer(
      "The page shows trajectory, scan, health, rates and latency; it takes no commands.\n"
      "Exit codes: 0 ok, 2 bad usage, address or network.");
  DdsOptions dds;
  std::string address = "127.0.0.1";
  std::uint16_t port = 8631;
  add_node_option(app, dds, "Namespace of the estimate to watch (aims)");
  add_domain_option(app, dds);
  app.add_option("--port", port, "Port of the page; 0: any free one (8631)");
  app.add_option("--address", address,
                 "Address that serves the page (127.0.0.1: this computer alone); there is no\n"
                 "password, so name another one in a network that you trust");
  return run_program(app, {argv + 1, argv + argc}, [&] { return watch(dds, address, port); });
}
