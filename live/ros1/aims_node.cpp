// SPDX-License-Identifier: BSD-3-Clause
#include "live/live_session.hpp"
#include "live/program.hpp"
#include "live/ros1/ros1_transport.hpp"

int main(int argc, char** argv) {
  using namespace aims;
  CLI::App app("Estimates a robot's motion live from ROS 1 topics and publishes it on ~odometry.",
               "aims_node");
  app.footer(
      "Topics and the node are renamed as ROS does (/a:=/b, __name:=c).\n"
      "Exit codes: 0 ok, 2 bad usage, configuration or topics.");
  LiveOptions options;
  add_live_options(app, options);
  return run_program(app, arguments_without_ros(argc, argv), [&]() -> Result<void> {
    const auto transport = connect_to_ros1(argc, argv, app.get_name());
    if (!transport) return tl::unexpected(transport.error());
    return run_live(**transport, options);
  });
}
