// SPDX-License-Identifier: BSD-3-Clause
// Estimates a trajectory with the installed libraries and prints it as TUM lines: of the recording
// that is given (consumer run.bag), or of ten made-up seconds at 0.5 m/s with a blind LiDAR.
#include <cstdio>
#include <cstdlib>

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

void walk(aims::Estimator& estimator) {
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
  const auto estimator = or_exit(aims::make_estimator("aims", aims::EstimatorConfig(), rig));
  recording ? replay(*recording, *estimator) : walk(*estimator);
  estimator->finish();
  std::fputs(aims::tum_text(estimator->result().trajectory).c_str(), stdout);
}
