// SPDX-License-Identifier: BSD-3-Clause
#include <benchmark/benchmark.h>

#include <cmath>
#include <filesystem>

#include "core/random.hpp"
#include "render/plots/map_picture.hpp"
#include "render/plots/trajectory_plot.hpp"
#include "render/scene/robot_pictures.hpp"
#include "sim/environment/scene_config.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

constexpr double kLength = 78.6;  // [m]

/// Points on floor, ceiling and walls of the default corridor.
std::vector<Eigen::Vector3f> corridor_points(std::int64_t count) {
  RandomStream random = rng(1, "bench.map");
  std::vector<Eigen::Vector3f> points;
  for (std::int64_t i = 0; i < count; ++i) {
    const double side = i % 2 == 0 ? -1.0 : 1.0;
    const bool wall = i % 4 < 2;
    const Eigen::Vector3d point(random.uniform(-3.0, kLength + 3.0),
                                wall ? 1.1 * side : random.uniform(-1.1, 1.1),
                                wall ? random.uniform(0.0, 2.6) : 1.3 + 1.3 * side);
    points.push_back((point + 0.01 * random.normal3()).cast<float>());
  }
  return points;
}

Trajectory straight_path(double drift) {
  Trajectory trajectory;
  for (int i = 0; i < 2000; ++i) {
    StampedPose sample;
    sample.stamp = i * 100 * kMillisecond;
    sample.pose.translation = {kLength * i / 2000.0, drift * std::sin(0.01 * i), 0.3};
    trajectory.push_back(sample);
  }
  return trajectory;
}

void report(benchmark::State& state, const Result<void>& written) {
  if (!written) state.SkipWithError(written.error().message.c_str());
}

void MapPictureFromAbove(benchmark::State& state) {
  const TemporaryFolder folder;
  MapPicture map;
  map.points = corridor_points(state.range(0));
  map.trajectory = straight_path(0.1);
  for (auto _ : state) {
    report(state, write_map_picture(folder.path() / "map.png", MapView::kAbove, map));
  }
}
BENCHMARK(MapPictureFromAbove)->Arg(100'000)->Arg(1'000'000)->Unit(benchmark::kMillisecond);

void TrajectoriesOfFiveEstimators(benchmark::State& state) {
  const TemporaryFolder folder;
  TrajectoryPlot plot;
  plot.scene = build_scene({}, 1);
  plot.truth = straight_path(0.0);
  for (int i = 1; i <= 5; ++i) plot.estimates.push_back({"estimate", straight_path(0.1 * i)});
  for (auto _ : state) report(state, write_trajectory_plot(folder.path() / "plot.png", plot));
}
BENCHMARK(TrajectoriesOfFiveEstimators)->Unit(benchmark::kMillisecond);

/// Model, context and three pictures of a body in the default corridor.
void RobotPictures(benchmark::State& state) {
  constexpr const char* kBody =
      "<mujoco><worldbody><body><freejoint/><geom type='capsule' size='0.1 0.2'/></body>"
      "</worldbody></mujoco>";
  const TemporaryFolder folder;
  const Scene scene = build_scene({}, 1);
  std::vector<RobotSnapshot> snapshots;
  for (int i = 0; i < 100; ++i) {
    snapshots.push_back({i * kSecond, {kLength * i / 100.0, 0.0, 0.3, 1.0, 0.0, 0.0, 0.0}});
  }
  for (auto _ : state) {
    const auto files = write_robot_pictures(folder.path(), "bench", scene, kBody, snapshots);
    if (!files) state.SkipWithError(files.error().message.c_str());
  }
}
BENCHMARK(RobotPictures)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace aims
