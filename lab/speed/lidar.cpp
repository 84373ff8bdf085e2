// SPDX-License-Identifier: BSD-3-Clause
// Rays per second in the corridor: ray casting alone, and whole scans with the return model.
#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>

#include "sim/environment/scene_config.hpp"
#include "sim/sensors/fisher_information.hpp"
#include "sim/sensors/lidar.hpp"

namespace aims {
namespace {

constexpr int kRings = 16;
constexpr int kColumns = 1800;

SceneConfig corridor(double bump_height, double clutter_density) {
  SceneConfig config;
  config.bumps.height = bump_height;
  config.corridor.clutter.density = clutter_density;
  return config;
}

/// The same with walls as they are built (`severity_9_relief`).
SceneConfig rough_corridor() {
  SceneConfig config = corridor(0.0, 0.0);
  config.surface.relief = 0.0015;
  config.surface.texture = 0.15;
  return config;
}

/// Packets of a scan from one point: 16 neighbouring azimuths of one ring each.
std::vector<RayPacket> scan_packets() {
  std::vector<RayPacket> packets;
  for (int first = 0; first + kRayPacketSize <= kColumns; first += kRayPacketSize) {
    for (int ring = 0; ring < kRings; ++ring) {
      RayPacket& packet = packets.emplace_back();
      const double elevation = (-15.0 + 2.0 * ring) * std::numbers::pi / 180.0;
      for (int lane = 0; lane < kRayPacketSize; ++lane) {
        const double azimuth = -2.0 * std::numbers::pi * (first + lane) / kColumns;
        packet.origin_x[lane] = 40.0F;
        packet.origin_y[lane] = 0.05F;
        packet.origin_z[lane] = 0.45F;
        packet.direction_x[lane] = static_cast<float>(std::cos(elevation) * std::cos(azimuth));
        packet.direction_y[lane] = static_cast<float>(std::cos(elevation) * std::sin(azimuth));
        packet.direction_z[lane] = static_cast<float>(std::sin(elevation));
      }
    }
  }
  return packets;
}

void cast_rays(benchmark::State& state, const SceneConfig& config) {
  const RayCaster caster(build_scene(config, 1));
  const std::vector<RayPacket> packets = scan_packets();
  HitPacket hits;
  for (auto _ : state) {
    for (const RayPacket& packet : packets) {
      caster.cast(packet, 100.0F, hits);
      benchmark::DoNotOptimize(hits);
    }
  }
  state.counters["rays/s"] =
      benchmark::Counter(static_cast<double>(packets.size() * kRayPacketSize),
                         benchmark::Counter::kIsIterationInvariantRate);
  state.counters["triangles"] = static_cast<double>(caster.triangle_count());
}

/// Poses of a walking robot at the physics rate.
Trajectory walking_poses(double from_x) {
  Trajectory poses;
  for (int i = 0; i <= 44; ++i) {
    const double t = 0.0025 * i;
    const Eigen::Vector3d rotation(0.03 * std::sin(15.0 * t), 0.02 * std::cos(15.0 * t), 0.1 * t);
    poses.push_back({from_seconds(t), {so3_exp(rotation), {from_x + 0.7 * t, 0.05, 0.45}}});
  }
  return poses;
}

/// Every error of the sensor switched on, as in models/sensors/field.yaml.
LidarConfig field_lidar() {
  LidarConfig config;
  config.range_sigma = 0.01;
  config.range_sigma_at_threshold = 0.03;
  config.range_resolution = 0.002;
  config.specular_loss = 0.5;
  config.intensity_sigma = 0.05;
  config.intensity_resolution = 0.01;
  config.beam = {.divergence_horizontal = 0.003,
                 .divergence_vertical = 0.0012,
                 .exit_width = 0.0127,
                 .exit_height = 0.0095};
  config.calibration = {.range_bias_sigma = 0.01,
                        .incidence_bias_mean = 0.0073,
                        .incidence_bias_sigma = 0.002,
                        .ring_range_sigma = 0.008,
                        .ring_elevation_sigma_deg = 0.03,
                        .azimuth_sigma_deg = 0.02};
  return config;
}

/// An Ouster OS1-128 in the mode of 2048 columns.
LidarConfig dense_lidar() {
  LidarConfig config = field_lidar();
  config.columns = 2048;
  config.ring_interval_us = 0.0;
  for (int ring = 0; ring < 128; ++ring) {
    config.table.elevations_deg.push_back(22.5 - 45.0 * ring / 127.0);
    config.table.azimuth_offsets_deg.push_back(4.2 - 2.8 * (ring % 4));
  }
  return config;
}

/// A Livox Mid-360, whose beams are computed anew for each scan.
LidarConfig rosette_lidar() {
  LidarConfig config = field_lidar();
  config.pattern = LidarPattern::kRosette;
  config.rosette = {.point_rate = 2e5,
                    .prism_deflections_deg = {67.5, 26.5},
                    .prism_rates = {-182.43, -172.71},
                    .line_offsets_deg = {-3.0, -1.0, 1.0, 3.0}};
  return config;
}

void scan(benchmark::State& state, const SceneConfig& config, const LidarConfig& sensor) {
  const RayCaster caster(build_scene(config, 1));
  Lidar lidar(sensor, caster, 1);
  const Trajectory poses = walking_poses(40.0);
  std::size_t points = 0;
  for (auto _ : state) {
    const LidarScan scan = lidar.scan(0, poses);
    points = scan.points.size();
    benchmark::DoNotOptimize(scan.points.data());
  }
  const ScanPattern& pattern = lidar.pattern();
  state.counters["rays/s"] =
      benchmark::Counter(static_cast<double>(pattern.lines()) * pattern.max_columns(),
                         benchmark::Counter::kIsIterationInvariantRate);
  state.counters["points"] = static_cast<double>(points);
}

/// As in a run: with the true hits and what they tell of the pose.
void scan_with_truth(benchmark::State& state, const LidarConfig& sensor) {
  const RayCaster caster(build_scene(corridor(0.0, 0.0), 1));
  Lidar lidar(sensor, caster, 1);
  const Trajectory poses = walking_poses(40.0);
  ScanTruth hits;
  for (auto _ : state) {
    const LidarScan scan = lidar.scan(0, poses, &hits);
    benchmark::DoNotOptimize(scan.points.data());
    benchmark::DoNotOptimize(scan_information(scan.end, hits, poses.back().pose, sensor.range_sigma,
                                              caster.first_moving_surface()));
  }
}

BENCHMARK_CAPTURE(cast_rays, doors, corridor(0.0, 0.0))->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(cast_rays, doors_relief, rough_corridor())->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(cast_rays, doors_clutter, corridor(0.0, 1.0))->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(cast_rays, doors_bumps, corridor(0.02, 0.0))->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(scan, doors_ideal, corridor(0.0, 0.0), LidarConfig{})
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(scan, doors_field, corridor(0.0, 0.0), field_lidar())
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(scan, doors_relief_field, rough_corridor(), field_lidar())
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(scan, doors_os1_128, corridor(0.0, 0.0), dense_lidar())
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(scan, doors_mid360, corridor(0.0, 0.0), rosette_lidar())
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(scan_with_truth, doors_ideal, LidarConfig{})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(scan_with_truth, doors_field, field_lidar())->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(scan, doors_clutter_ideal, corridor(0.0, 1.0), LidarConfig{})
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(scan, doors_clutter_field, corridor(0.0, 1.0), field_lidar())
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(scan, doors_bumps_ideal, corridor(0.02, 0.0), LidarConfig{})
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(scan, doors_bumps_field, corridor(0.02, 0.0), field_lidar())
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace aims
