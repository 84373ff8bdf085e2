// SPDX-License-Identifier: BSD-3-Clause
#include <benchmark/benchmark.h>

#include "sim/robot/stance_forces.hpp"
#include "tests/support/walking.hpp"

namespace aims {
namespace {

/// One simulated second of trotting per iteration; the counter is the real-time factor.
void walk_corridor(benchmark::State& state) {
  const double bump_height = 0.01 * static_cast<double>(state.range(0));
  RouteConfig route;
  route.points = {{"a", 0.0, 0.0}, {"b", 78.6, 0.0}, {"a", 0.0, 0.0}};
  route.stand_before = 0.0;
  Walker walker =
      Walker::create(testing::corridor_world(78.6, 0.8, bump_height), {}, route).value();
  for (auto _ : state) {
    for (int i = 0; i < 400; ++i) walker.step();
  }
  state.counters["realtime_factor"] =
      benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}
BENCHMARK(walk_corridor)->Arg(0)->Arg(2)->ArgName("bump_cm")->Unit(benchmark::kMillisecond);

void distribute_forces(benchmark::State& state) {
  StanceProblem problem;
  problem.mass = 12.6;
  problem.inertia = Eigen::Vector3d(0.16, 0.41, 0.43).asDiagonal();
  problem.lever = {
      {{0.19, 0.14, -0.28}, {0.19, -0.14, -0.28}, {-0.19, 0.14, -0.28}, {-0.19, -0.14, -0.28}}};
  problem.stands = {true, false, false, true};
  problem.acceleration << 3.0, 0.0, 10.0, 8.0, 4.0, 2.0;
  for (auto _ : state) benchmark::DoNotOptimize(stance_forces(problem, {}));
}
BENCHMARK(distribute_forces);

}  // namespace
}  // namespace aims
