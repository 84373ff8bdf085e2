// SPDX-License-Identifier: BSD-3-Clause
// Real-time factor of a whole run on one thread, and of its parts.
#include <benchmark/benchmark.h>

#include "bench/run/evaluate.hpp"

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
    const auto result =
        run(ten_metres(), {.seed = 1, .jobs = 1}, [](const Progress&) { return true; });
    simulated_s += result->simulated_s;
    physics_s += result->simulation_times.physics;
    lidar_s += result->simulation_times.lidar;
    aims_s += result->estimators.front().wall_s;
    scans += result->estimators.front().result.trajectory.size();
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
