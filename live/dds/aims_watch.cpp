// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cstdio>
#include <memory>
#include <string>

#include "live/dds/dds_program.hpp"
#include "live/dds/dds_transport.hpp"
#include "live/dds/discovery.hpp"
#include "live/watch/watch_page.hpp"
#include "live/watch/watch_state.hpp"
#include "live/watch/web_server.hpp"

namespace aims {
namespace {

constexpr const char* kProgram = "aims_watch";
constexpr double kPoll = 0.2;  ///< [s]

struct WatchArguments {
  DdsOptions dds;
  std::string address = "127.0.0.1";
  std::uint16_t port = 8631;
};

void add_options(CLI::App& app, WatchArguments& arguments) {
  app.add_option("--node", arguments.dds.node, "Namespace of the estimate to watch (aims)");
  app.add_option("--domain", arguments.dds.domain, "DDS domain ($ROS_DOMAIN_ID, else 0)")
      ->check(CLI::Range(0, 232));
  app.add_option("--port", arguments.port, "Port of the page; 0: any free one (8631)");
  app.add_option("--address", arguments.address,
                 "Address that serves the page (127.0.0.1: this computer alone); there is no\n"
                 "password, so name another one in a network that you trust");
  app.footer(
      "The page shows trajectory, scan, health, rates and latency; it takes no commands.\n"
      "Exit codes: 0 ok, 2 bad usage, address or network.");
}

/// The number behind `name` in "/state.json?epoch=1&from=2"; 0 without.
std::uint64_t number_in(const std::string& target, const std::string& name) {
  std::uint64_t number = 0;
  const std::size_t found = target.find(name + "=");
  if (found == std::string::npos) return number;
  const char* begin = target.data() + found + name.size() + 1;
  std::from_chars(begin, target.data() + target.size(), number);
  return number;
}

WebContent content_of(const WatchState& state, const std::string& target) {
  if (target == "/") return {"text/html; charset=utf-8", std::string(watch_page())};
  if (target.starts_with("/state.json")) {
    return {"application/json", state.json(number_in(target, "epoch"), number_in(target, "from"))};
  }
  return {};
}

int run(const WatchArguments& arguments) {
  if (watch_page().empty()) {
    return report_bad_input(kProgram, "built without its page: build again where npm works");
  }
  const auto transport = DdsTransport::connect(arguments.dds);
  if (!transport) return report_bad_input(kProgram, transport.error().message);
  (*transport)->limit_wait(kSecond);
  (*transport)->subscribe("~odometry", "nav_msgs/Odometry");
  (*transport)->subscribe("~cloud", "sensor_msgs/PointCloud2");
  (*transport)->subscribe("/diagnostics", "diagnostic_msgs/DiagnosticArray");
  WatchState state((*transport)->resolved("~odometry"));
  const auto server =
      WebServer::start(arguments.address, arguments.port,
                       [&](const std::string& target) { return content_of(state, target); });
  if (!server) return report_bad_input(kProgram, server.error().message);
  fmt::print("watching {}: http://{}:{}/\n", (*transport)->resolved("~odometry"), arguments.address,
             (*server)->port());
  std::fflush(stdout);
  while ((*transport)->running()) {
    if (const auto message = (*transport)->wait(kPoll)) state.take(*message);
  }
  return kLiveOk;
}

int main_of(int argc, char** argv) {
  WatchArguments arguments;
  const auto domain = default_domain();
  if (!domain) return report_bad_input(kProgram, domain.error().message);
  arguments.dds.domain = *domain;
  CLI::App app("Shows a live estimate in a browser.", kProgram);
  add_options(app, arguments);
  if (const auto exit_code = exit_after_parsing(app, kProgram, argc, argv)) return *exit_code;
  return run(arguments);
}

}  // namespace
}  // namespace aims

int main(int argc, char** argv) {
  return aims::guarded_main(aims::kProgram, [&] { return aims::main_of(argc, argv); });
}
