// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/pcap/velodyne_models.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace aims {
namespace {

// VLP-16 user manual 63-9243, Puck Hi-Res 63-9318: both fire alike, every second beam upwards.
constexpr VelodyneModel puck(std::uint8_t code, std::string_view name, double highest) {
  VelodyneModel model{
      .code = code, .name = name, .lasers = 16, .sequence_time = 55'296.0, .laser_time = 2'304.0};
  for (std::size_t i = 0; i < 16; ++i) {
    const double rank = static_cast<double>(i % 2 == 0 ? i / 2 : 8 + i / 2);
    model.elevation[i] = highest * (2.0 * rank / 15.0 - 1.0);
  }
  return model;
}

constexpr VelodyneModel vlp16() {
  VelodyneModel model = puck(0x22, "VLP-16", 15.0);
  model.height = {11.2, -0.7, 9.7, -2.2, 8.1, -3.7, 6.6, -5.1,
                  5.1,  -6.6, 3.7, -8.1, 2.2, -9.7, 0.7, -11.2};
  return model;
}

// HDL-32E user manual 63-9113: 32 beams a third of four degrees apart, from below and from the
// middle in turn.
constexpr VelodyneModel hdl32e() {
  VelodyneModel model{.code = 0x21,
                      .name = "HDL-32E",
                      .lasers = 32,
                      .sequence_time = 46'080.0,
                      .laser_time = 1'152.0};
  for (std::size_t i = 0; i < 32; ++i) {
    const double rank = static_cast<double>(i % 2 == 0 ? i / 2 : 16 + i / 2);
    model.elevation[i] = (-92.0 + 4.0 * rank) / 3.0;
  }
  return model;
}

// VLP-32C user manual 63-9325: pairs of beams fire together.
constexpr VelodyneModel vlp32c() {
  return {.code = 0x28,
          .name = "VLP-32C",
          .lasers = 32,
          .at_once = 2,
          .unit = 0.004,
          .sequence_time = 55'296.0,
          .laser_time = 2'304.0,
          .elevation = {-25.0,  -1.0,  -1.667, -15.639, -11.31, 0.0,   -0.667, -8.843,
                        -7.254, 0.333, -0.333, -6.148,  -5.333, 1.333, 0.667,  -4.0,
                        -4.667, 1.667, 1.0,    -3.667,  -3.333, 3.333, 2.333,  -2.667,
                        -3.0,   7.0,   4.667,  -2.333,  -2.0,   15.0,  10.333, -1.333},
          .azimuth = {1.4,  -4.2, 1.4,  -1.4, 1.4,  -1.4, 4.2,  -1.4, 1.4,  -4.2, 1.4,
                      -1.4, 4.2,  -1.4, 4.2,  -1.4, 1.4,  -4.2, 1.4,  -4.2, 4.2,  -1.4,
                      1.4,  -1.4, 1.4,  -1.4, 1.4,  -4.2, 4.2,  -1.4, 1.4,  -1.4}};
}

constexpr std::array<VelodyneModel, 4> kModels = {vlp16(), puck(0x24, "Puck Hi-Res", 10.0),
                                                  hdl32e(), vlp32c()};

}  // namespace

const VelodyneModel* velodyne_model(std::uint8_t code) {
  const auto* const found = std::ranges::find(kModels, code, &VelodyneModel::code);
  return found == kModels.end() ? nullptr : found;
}

std::string velodyne_name(std::uint8_t code) {
  std::string_view name = "an unknown Velodyne";
  if (code == 0x23) name = "a VLP-32A or VLP-32B";
  if (code == 0x31) name = "a Velarray";
  if (code == 0xa1) name = "a VLS-128";
  if (code == 0x00) name = "an HDL-64E, or of no stated model";
  if (const VelodyneModel* model = velodyne_model(code)) return fmt::format("a {}", model->name);
  return fmt::format("{} (0x{:02x})", name, code);
}

}  // namespace aims
