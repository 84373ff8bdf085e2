// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <string>

#include "tests/independent/cells.hpp"
#include "tests/independent/recording.hpp"

namespace aims::independent {
namespace {

int run(int argc, char** argv) {
  CLI::App app("Write a synthetic recording; shares no code with the simulator");
  RecordingOptions options;
  std::string bag;
  app.add_option("cell", options.cell, fmt::format("Place: {}", fmt::join(cell_names(), ", ")))
      ->required();
  app.add_option("--imu-rate", options.imu_rate_hz, "Rate of the IMU [Hz] (200)");
  app.add_option("--seed", options.seed, "Seed of motion and noise (1)");
  app.add_option("--length", options.length, "Route, one way [m] (that of the cell)");
  app.add_option("--legs-scale", options.legs_scale, "Reported over true leg velocity (1.045)");
  app.add_option("--rings", options.rings, "Elevations: uneven, uniform or 32 (uneven)");
  app.add_option("--relief", options.relief, "Deviation of the walls from planes [m] (0)");
  app.add_option("--range-noise", options.range_noise, "Deviation of a LiDAR range [m] (0.02)");
  app.add_option("--outliers", options.outliers, "Fraction of returns that are too short (0.002)");
  app.add_option("--vibration", options.vibration, "Factor on the vibration of the IMU (1)");
  app.add_flag("--lz4", options.compress, "Compress the bag");
  app.add_option("-o,--out", bag, "Bag to write; truth and waypoint times beside it")->required();
  CLI11_PARSE(app, argc, argv);
  if (const auto ok = write_recording(options, bag); !ok) {
    fmt::print(stderr, "independent_recordings: {}\n", ok.error().message);
    return 2;
  }
  return 0;
}

}  // namespace
}  // namespace aims::independent

int main(int argc, char** argv) {
  try {
    return aims::independent::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "independent_recordings: internal error: %s\n", error.what());
    return 3;
  }
}
