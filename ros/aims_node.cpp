// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bench/run/estimate.hpp"
#include "core/files/tum.hpp"
#include "estimator/registry.hpp"
#include "ros/live_recording.hpp"
#include "ros/node_options.hpp"
#include "ros/odometry_publisher.hpp"
#include "ros/transport.hpp"

namespace aims {
namespace {

constexpr int kOk = 0;
constexpr int kBadInput = 2;
constexpr int kInternal = 3;

/// Deliveries are handed over in pieces of so much record time.
constexpr Duration kBatch = 5 * kMillisecond;

int bad_input(const Error& error) {
  fmt::print(stderr, "aims_node: {}\n", error.message);
  return kBadInput;
}

void say(const std::string& text) {
  fmt::print("{}\n", text);
  std::fflush(stdout);  // roslaunch reads from a pipe
}

Result<EstimateConfig> config_of(const NodeOptions& options) {
  std::vector<std::string> overrides = {fmt::format("estimators=[{}]", options.estimator)};
  overrides.insert(overrides.end(), options.overrides.begin(), options.overrides.end());
  auto config = load_estimate_config(options.config, overrides);
  if (!config) return config;
  if (auto known = make_estimator(options.estimator, config->estimator, SensorRig{}); !known) {
    return tl::unexpected(known.error());
  }
  config->recording.topics.truth = "none";  // for scoring alone
  return config;
}

/// Estimates until the network ends it; then the rest that the estimator held back.
Result<void> follow(RecordingReader& reader, Estimator& estimator, OdometryPublisher& publisher) {
  std::vector<Delivery> deliveries;
  bool more = true;
  while (more) {
    const auto advanced = reader.advance(kBatch, deliveries);
    if (!advanced) return tl::unexpected(advanced.error());
    more = *advanced;
    for (const Delivery& delivery : deliveries) estimator.consume(delivery);
    publisher.publish(estimator.result().trajectory);
    deliveries.clear();
  }
  estimator.finish();
  return {};
}

void print_summary(const RecordingReader& reader, const Estimator& estimator, std::size_t dropped) {
  for (const auto& [event, count] : reader.counts()) say(fmt::format("note: {}: {}", event, count));
  for (const auto& [event, count] : estimator.result().counts) {
    say(fmt::format("note: {}: {}", event, count));
  }
  if (dropped > 0) say(fmt::format("note: {} messages left out, since the node was late", dropped));
  say(fmt::format("{} poses", estimator.result().trajectory.size()));
}

int run_node(RosTransport& transport, const NodeOptions& options) {
  const auto config = config_of(options);
  if (!config) return bad_input(config.error());
  const LiveRecordingOptions live{.settle = from_seconds(options.settle),
                                  .patience = options.patience};
  auto reader = open_live_recording(
      transport, config->recording, live,
      [&](const RecordingSetup& setup) { return check_topics(*config, setup, "live topics"); },
      [](const std::string& missing) { say("waiting: " + missing); });
  if (!reader) return bad_input(reader.error());
  RecordingSetup setup = reader->setup();
  const EstimatorConfig own = estimator_config_for(*config, setup);
  for (const std::string& note : setup.notes) say("note: " + note);
  auto estimator = make_estimator(options.estimator, own, setup.rig);
  if (!estimator) return bad_input(estimator.error());

  OdometryPublisher publisher(transport, {options.odom_frame, options.body_frame, options.tf});
  say(fmt::format("{} publishes {}", options.estimator, transport.resolved("~odometry")));
  if (auto ok = follow(*reader, **estimator, publisher); !ok) return bad_input(ok.error());
  print_summary(*reader, **estimator, transport.dropped());
  if (options.out.empty()) return kOk;
  const auto written = write_tum(options.out, (*estimator)->result().trajectory);
  return written ? kOk : bad_input(written.error());
}

int main_of(int argc, char** argv) {
  auto command = parse_node_arguments(RosTransport::own_arguments(argc, argv));
  if (!command) return bad_input(command.error());
  if (!command->help.empty()) {
    say(command->help);
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
