// SPDX-License-Identifier: BSD-3-Clause
// Writing, reading and decoding bags with the messages of a robot: point clouds of 0.75 MB at 10 Hz,
// IMU at 50 Hz, leg odometry at 200 Hz. Files are in TMPDIR, so this measures the code and the page
// cache.
#include <benchmark/benchmark.h>

#include <filesystem>
#include <random>
#include <string>

#include "recordings/bag/bag_reader.hpp"
#include "recordings/bag/bag_writer.hpp"
#include "recordings/messages/message_decoder.hpp"
#include "recordings/messages/message_encoding.hpp"
#include "recordings/messages/message_types.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

constexpr int kPoints = 34'000;

/// Points like those of a sensor: smooth along the scan, noisy in the last millimetres.
MessageBytes sample_cloud() {
  LidarScan scan;
  std::mt19937 random(1);
  std::normal_distribution<float> noise(0.0F, 0.02F);
  for (int i = 0; i < kPoints; ++i) {
    LidarPoint point;
    const float angle = static_cast<float>(i) * 2e-4F;
    const float range = 3.0F + noise(random);
    point.position = {range * std::cos(angle), range * std::sin(angle), 0.1F * (i % 16)};
    point.intensity = 0.5F;
    point.ring = static_cast<std::uint16_t>(i % 16);
    point.time_offset_ns = i * 3000;
    scan.points.push_back(point);
  }
  return cloud_message({0, kSecond, "lidar"}, scan);
}

MessageBytes sample_odometry() {
  return odometry_message({1, kSecond, "odom"}, "base", OdometryContent{});
}

/// Writes the messages of `scans` tenths of a second; returns their size [bytes].
std::int64_t write_robot(const std::filesystem::path& file, BagCompression compression,
                         std::int64_t scans) {
  static const MessageBytes cloud = sample_cloud();
  static const MessageBytes odometry = sample_odometry();
  static const MessageBytes imu =
      imu_message({1, kSecond, "imu"}, ImuSample{});
  auto bag = BagWriter::create(file, {compression}).value();
  const auto clouds = bag.add_connection("/lidar/points", point_cloud_type());
  const auto legs = bag.add_connection("/leg_odometry", odometry_type());
  const auto imus = bag.add_connection("/imu/data", imu_type());
  std::int64_t bytes = 0;
  const auto put = [&](std::uint32_t connection, Time time, const MessageBytes& message) {
    bytes += static_cast<std::int64_t>(message.view().size());
    if (!bag.write(connection, time, message.view())) std::abort();
  };
  for (int scan = 0; scan < scans; ++scan) {
    const Time start = kSecond + scan * 100 * kMillisecond;
    for (int i = 0; i < 20; ++i) put(legs, start + i * 5 * kMillisecond, odometry);
    for (int i = 0; i < 5; ++i) put(imus, start + i * 20 * kMillisecond, imu);
    put(clouds, start + 100 * kMillisecond, cloud);
  }
  if (!bag.close()) std::abort();
  return bytes;
}

void write_bag(benchmark::State& state) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "bench.bag";
  const auto compression = static_cast<BagCompression>(state.range(0));
  std::int64_t bytes = 0;
  for (auto _ : state) {
    const std::int64_t size = write_robot(file, compression, state.range(1));
    state.PauseTiming();
    bytes += size;
    const auto on_disk = static_cast<double>(std::filesystem::file_size(file));
    state.counters["file_fraction"] = on_disk / static_cast<double>(size);
    std::filesystem::remove(file);
    state.ResumeTiming();
  }
  state.SetBytesProcessed(bytes);
}

void read_bag(benchmark::State& state) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "bench.bag";
  const auto compression = static_cast<BagCompression>(state.range(0));
  const std::int64_t size = write_robot(file, compression, state.range(1));
  for (auto _ : state) {
    auto bag = BagReader::open(file).value();
    std::size_t total = 0;
    for (auto message = bag.next(); message.value(); message = bag.next()) {
      total += (*message)->data.size();
    }
    if (static_cast<std::int64_t>(total) != size) std::abort();
  }
  state.SetBytesProcessed(size * static_cast<std::int64_t>(state.iterations()));
}

void decode_odometry(benchmark::State& state) {
  const MessageType type = odometry_type();
  const auto decoder = MessageDecoder::create(type.name, type.definition).value();
  const MessageBytes bytes = sample_odometry();
  for (auto _ : state) {
    const MessageView view = decoder.decode(bytes.view()).value();
    double sum = static_cast<double>(view.time("header.stamp").value());
    for (const char* path :
         {"pose.pose.position.x", "pose.pose.position.y", "pose.pose.position.z",
          "pose.pose.orientation.x", "pose.pose.orientation.y", "pose.pose.orientation.z",
          "pose.pose.orientation.w", "twist.twist.linear.x", "twist.twist.linear.y",
          "twist.twist.linear.z", "twist.twist.angular.x", "twist.twist.angular.y",
          "twist.twist.angular.z"}) {
      sum += view.number(path).value();
    }
    benchmark::DoNotOptimize(sum);
  }
}

void decode_cloud(benchmark::State& state) {
  const MessageType type = point_cloud_type();
  const auto decoder = MessageDecoder::create(type.name, type.definition).value();
  const MessageBytes bytes = sample_cloud();
  for (auto _ : state) {
    const MessageView view = decoder.decode(bytes.view()).value();
    benchmark::DoNotOptimize(view.bytes("data")->data());
    benchmark::DoNotOptimize(view.size("fields"));
  }
}

/// Compression and number of scans; fewer for bz2, which is slow.
void sizes(benchmark::internal::Benchmark* bench) {
  bench->ArgNames({"compression", "scans"})->Args({0, 100})->Args({1, 100})->Args({2, 5});
  bench->Unit(benchmark::kMillisecond)->UseRealTime();
}

BENCHMARK(write_bag)->Apply(sizes);
BENCHMARK(read_bag)->Apply(sizes);
BENCHMARK(decode_odometry);
BENCHMARK(decode_cloud);

}  // namespace
}  // namespace aims
