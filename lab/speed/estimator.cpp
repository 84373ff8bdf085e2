// SPDX-License-Identifier: BSD-3-Clause
#include <benchmark/benchmark.h>

#include <array>

#include "core/random.hpp"
#include "estimator/lidar/plane_model.hpp"
#include "estimator/lidar/voxel_map.hpp"
#include "estimator/registry.hpp"
#include "tests/support/kinematic_world.hpp"

namespace aims {
namespace {

/// Returns of the inside of a corridor segment, 2 cm of noise.
std::vector<Eigen::Vector3f> corridor_points(int count, std::uint64_t seed) {
  RandomStream random(seed, "estimator_bench");
  const test::CorridorShape corridor;
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d origin(random.uniform(20.0, 60.0), 0.0, 0.5);
    const Eigen::Vector3d direction = random.normal3().normalized();
    const double range = cast_ray(corridor, origin, direction).distance + 0.02 * random.normal();
    points.push_back((origin + range * direction).cast<float>());
  }
  return points;
}

void nearest_neighbours(benchmark::State& state) {
  VoxelMap map{MapConfig{}};
  for (const std::uint64_t seed : {1, 3}) {  // one insertion fills one half
    map.insert(corridor_points(300000, seed), Eigen::Vector3f::Zero());
  }
  const auto queries = corridor_points(4096, 2);
  std::size_t i = 0;
  std::array<Neighbors, kHalves> neighbors;
  for (auto _ : state) {
    map.nearest(queries[i++ % queries.size()], neighbors);
    benchmark::DoNotOptimize(neighbors);
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(nearest_neighbours);

void insertion(benchmark::State& state) {
  const auto points = corridor_points(10000, 1);
  VoxelMap map{MapConfig{}};
  for (auto _ : state) map.insert(points, Eigen::Vector3f::Zero());
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(points.size()));
}
BENCHMARK(insertion)->Unit(benchmark::kMillisecond);

void plane_fits(benchmark::State& state) {
  const PlanePoints half = {Eigen::Vector3f(0.1F, 0.0F, 1.0F), Eigen::Vector3f(-0.1F, 0.02F, 1.01F),
                            Eigen::Vector3f(0.0F, 0.1F, 0.99F), Eigen::Vector3f(0.03F, -0.1F, 1.0F),
                            Eigen::Vector3f(0.0F, 0.0F, 1.005F)};
  const Eigen::Vector3f query(0.01F, 0.01F, 1.0F);
  for (auto _ : state) benchmark::DoNotOptimize(fit_planes({half, half}, query));
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(plane_fits);

/// Twelve seconds of walking with full scans of 28,800 rays; the counter is the time per scan,
/// inertial prediction and leg updates included.
void time_per_scan(benchmark::State& state, const char* name) {
  test::KinematicConfig config;
  config.walk.distance = 7.0;
  config.walk.there_and_back = false;
  test::KinematicWorld world(config);
  std::vector<Delivery> deliveries;
  world.advance(world.duration(), deliveries);
  std::size_t scans = 0;
  for (auto _ : state) {
    auto estimator = make_estimator(name, world.rig());
    for (const Delivery& delivery : deliveries) (*estimator)->consume(delivery);
    (*estimator)->finish();
    scans += (*estimator)->result().trajectory.size();
  }
  state.counters["per_scan"] = benchmark::Counter(
      static_cast<double>(scans), benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK_CAPTURE(time_per_scan, aims, "aims")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(time_per_scan, lio, "lio")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(time_per_scan, fast_lio2, "fast_lio2")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(time_per_scan, loam, "loam")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(time_per_scan, a_loam, "a_loam")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(time_per_scan, lego_loam, "lego_loam")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(time_per_scan, lio_sam, "lio_sam")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(time_per_scan, lins, "lins")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(time_per_scan, leg_kilo, "leg_kilo")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace aims
