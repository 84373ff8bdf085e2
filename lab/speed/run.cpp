// SPDX-License-Identifier: BSD-3-Clause
// Real-time factor of a whole run on one thread, and of its parts.
#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include "bench/estimate/stream.hpp"
#include "bench/scenario/scenario.hpp"
#include "sim/simulation.hpp"

namespace aims {
namespace {

Scenario ten_metres() {
  Scenario scenario;
  scenario.name = "ten_metres";
  scenario.simulation.scene.corridor.length = 78.6;
  scenario.simulation.route.points = {{"a", 0.0, 0.0}, {"b", 10.0, 0.0}};
  scenario.simulation.route.stand_before = 2.5;
  return scenario;
}

void whole_run(benchmark::State& state) {
  double simulated_s = 0.0;
  double physics_s = 0.0;
  double lidar_s = 0.0;
  double aims_s = 0.0;
  std::size_t scans = 0;
  for (auto _ : state) {
    auto simulation = Simulation::create(ten_metres().simulation, 1);
    const std::vector<std::string> specs = {"aims"};
    auto estimators = make_estimators(specs, ten_metres().estimators, simulation->rig());
    std::vector<Delivery> batch;
    for (bool moving = true; moving;) {
      batch.clear();
      moving = simulation->advance(kStreamBatch, batch);
      estimators->front().consume(batch);
    }
    estimators->front().finish();
    simulated_s += to_seconds(simulation->now());
    physics_s += simulation->times().physics;
    lidar_s += simulation->times().lidar;
    aims_s += estimators->front().total_seconds();
    scans += estimators->front().estimator().result().trajectory.size();
  }
  state.counters["realtime_factor"] = benchmark::Counter(simulated_s, benchmark::Counter::kIsRate);
  state.counters["physics_realtime_factor"] = simulated_s / physics_s;
  state.counters["lidar_realtime_factor"] = simulated_s / lidar_s;
  state.counters["aims_realtime_factor"] = simulated_s / aims_s;
  state.counters["aims_ms_per_scan"] = 1e3 * aims_s / static_cast<double>(scans);
}
BENCHMARK(whole_run)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace aims
