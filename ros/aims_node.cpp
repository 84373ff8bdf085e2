// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/files/tum.hpp"
#include "estimator/estimator_spec.hpp"
#include "ros/live_recording.hpp"
#include "ros/node_config.hpp"
#include "ros/node_options.hpp"
#include "ros/odometry_publisher.hpp"
#include "ros/transport.hpp"

namespace aims {
namespace {

constexpr int kOk = 0;
constexpr int kBadInput = 2;
constexpr int kInternal = 3;

/// Record time of one batch of deliveries.
constexpr Duration kBatch = 5 * kMillisecond;

int bad_input(const Error& error) {
  fmt::print(stderr, "aims_node: {}\n", error.message);
  return kBadInput;
}

void print_line(const std::string& text) {
  fmt::print("{}\n", text);
  std::fflush(stdout);  // roslaunch reads from a pipe
}

/// Prints state and reasons of the rows from `next` on that differ from those before.
void print_health(const std::vector<HealthRow>& rows, std::size_t& next) {
  for (; next < rows.size(); ++next) {
    const HealthRow& row = rows[next];
    if (next > 0 && row.state == rows[next - 1].state && row.reasons == rows[next - 1].reasons) {
      continue;
    }
    print_line(fmt::format("health at {:.1f} s: {}{}{}", to_seconds(row.stamp), name_of(row.state),
                           row.reasons.empty() ? "" : ": ", fmt::join(row.reasons, "; ")));
  }
}

/// Estimates until the node is asked to end, then processes what the estimator has queued.
Result<void> estimate_live(RecordingReader& reader, Estimator& estimator,
                           OdometryPublisher& publisher) {
  std::vector<Delivery> deliveries;
  std::size_t health_printed = 0;
  bool more = true;
  while (more) {
    const auto advanced = reader.advance(kBatch, deliveries);
    if (!advanced) return tl::unexpected(advanced.error());
    more = *advanced;
    for (const Delivery& delivery : deliveries) estimator.consume(delivery);
    publisher.publish(estimator.result().trajectory);
    print_health(estimator.result().health, health_printed);
    deliveries.clear();
  }
  estimator.finish();
  return {};
}

void print_summary(const RecordingReader& reader, const Estimator& estimator, std::size_t dropped) {
  for (const auto& [event, count] : reader.counts())
    print_line(fmt::format("note: {}: {}", event, count));
  for (const auto& [event, count] : estimator.result().counts) {
    print_line(fmt::format("note: {}: {}", event, count));
  }
  if (dropped > 0)
    print_line(fmt::format("note: {} messages dropped, since the node was too slow", dropped));
  print_line(fmt::format("{} poses", estimator.result().trajectory.size()));
}

Result<void> check_topics(const NodeConfig& config, const RecordingSetup& setup) {
  if (!requirements_of(config.estimator, config.estimators).legs) return {};
  return check_legs(setup, config.estimator, "live topics");
}

/// The estimator; prints what was assumed about the network.
Result<std::unique_ptr<Estimator>> make_live_estimator(const NodeConfig& config,
                                                       const RecordingSetup& setup) {
  for (const std::string& note : setup.notes) print_line("note: " + note);
  for (const ReadingWarning& each : setup.warnings) print_line("warning: " + each.text);
  const auto spec = parse_estimator_spec(config.estimator);
  if (!spec) return tl::unexpected(spec.error());
  const auto own = config_with(*spec, config.estimators);
  if (!own) return tl::unexpected(own.error());
  return (*own)->create(setup.rig);
}

int run_node(RosTransport& transport, const NodeOptions& options) {
  const auto config = load_node_config(options);
  if (!config) return bad_input(config.error());
  const LiveRecordingOptions live{.settle = from_seconds(options.settle),
                                  .patience = options.patience};
  auto reader = open_live_recording(
      transport, config->recording, live,
      [&](const RecordingSetup& setup) { return check_topics(*config, setup); },
      [](const std::string& missing) { print_line("waiting: " + missing); });
  if (!reader) return bad_input(reader.error());
  auto estimator = make_live_estimator(*config, reader->setup());
  if (!estimator) return bad_input(estimator.error());

  OdometryPublisher publisher(transport, {options.odom_frame, options.body_frame, options.tf});
  print_line(fmt::format("{} publishes {}", options.estimator, transport.resolved("~odometry")));
  if (auto ok = estimate_live(*reader, **estimator, publisher); !ok) return bad_input(ok.error());
  print_summary(*reader, **estimator, transport.dropped());
  if (options.out.empty()) return kOk;
  const auto written = write_tum(options.out, (*estimator)->result().trajectory);
  return written ? kOk : bad_input(written.error());
}

int main_of(int argc, char** argv) {
  auto command = parse_node_arguments(RosTransport::own_arguments(argc, argv));
  if (!command) return bad_input(command.error());
  if (!command->help.empty()) {
    print_line(command->help);
    return kOk;
  }
  std::string problem;
  const auto transport = RosTransport::connect(argc, argv, "aims_node", problem);
  if (!transport) return bad_input({problem});
  if (auto ok = apply_parameters(transport->parameters(), *command); !ok) {
    return bad_input(ok.error());
  }
  return run_node(*transport, command->options);
}

}  // namespace
}  // namespace aims

int main(int argc, char** argv) {
  try {
    return aims::main_of(argc, argv);
  } catch (const std::exception& error) {
    fmt::print(stderr, "aims_node: internal error: {}\n", error.what());
    return aims::kInternal;
  }
}
