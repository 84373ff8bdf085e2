// SPDX-License-Identifier: BSD-3-Clause
// Estimates a trajectory with the installed libraries and prints it as TUM lines: of the recording
// that is given (consumer run.bag), with its final error against the recording's truth on stderr,
// or of ten synthetic seconds at 0.5 m/s with empty scans.
#include <cstdio>
#include <cstdlib>

#include "bench/metrics/absolute_error.hpp"
#include "bench/metrics/alignment.hpp"
#include "core/files/tum.hpp"
#include "core/measurements.hpp"
#include "estimator/registry.hpp"
#include "recordings/stream/recording_reader.hpp"

template <class Value>
Value or_exit(aims::Result<Value> result) {
  if (result) return std::move(*result);
  std::fprintf(stderr, "%s\n", result.error().message.c_str());
  std::exit(2);
}

void walk_straight(aims::Estimator& estimator) {
  using aims::kMillisecond;
  for (aims::Time now = 0; now <= 14'000 * kMillisecond; now += 5 * kMillisecond) {
    aims::LegOdometrySample legs;
    legs.stamp = now;
    if (now > 4'000 * kMillisecond) legs.linear_velocity.x() = 0.5;  // after standing still
    estimator.consume({now, legs});
    if (now % (20 * kMillisecond) == 0)
      estimator.consume({now, aims::ImuSample{now, {0.0, 0.0, 0.0}, {0.0, 0.0, 9.81}}});
    if (now % (100 * kMillisecond) == 0)
      estimator.consume({now, std::make_shared<aims::LidarScan>(now - 100 * kMillisecond, now)});
  }
}

void print_end_error(const aims::Trajectory& estimate, const aims::Trajectory& truth) {
  const auto pairs = aims::associate(estimate, truth, aims::Association::kInterpolated, 0);
  const auto error = aims::end_error(aims::aligned(pairs, aims::align_start(pairs)));
  if (error) std::fprintf(stderr, "end error %.3f m\n", error->norm_m);
}

void replay(aims::RecordingReader& recording, aims::Estimator& estimator) {
  std::vector<aims::Delivery> deliveries;
  for (bool more = true; more; deliveries.clear()) {
    more = or_exit(recording.advance(aims::kSecond, deliveries));
    for (const aims::Delivery& each : deliveries) estimator.consume(each);
  }
}

int main(int argc, char** argv) {
  std::optional<aims::RecordingReader> recording;
  if (argc > 1) recording = or_exit(aims::RecordingReader::open(argv[1], {}));
  const aims::SensorRig rig = recording ? recording->setup().rig : aims::SensorRig();
  const auto estimator = or_exit(aims::make_estimator("aims", rig));
  recording ? replay(*recording, *estimator) : walk_straight(*estimator);
  estimator->finish();
  if (recording) print_end_error(estimator->result().trajectory, recording->truth());
  std::fputs(aims::tum_text(estimator->result().trajectory).c_str(), stdout);
}
