// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace aims {

/// How a Velodyne sensor fires: a block holds 32 returns, of two sequences of 16 lasers or of one
/// of
/// 32. The nominal beams of its manual, without a calibration of its own.
struct VelodyneModel {
  std::uint8_t code = 0;  ///< factory byte of its packets
  std::string_view name;
  std::size_t lasers = 16;             ///< of a sequence
  std::size_t at_once = 1;             ///< lasers that fire together
  double unit = 0.002;                 ///< of a distance [m]
  double sequence_time = 0.0;          ///< with its recharge [ns]
  double laser_time = 0.0;             ///< between firings [ns]
  std::array<double, 32> elevation{};  ///< by laser [deg]
  std::array<double, 32> azimuth{};    ///< ahead of the block's, clockwise [deg]
  std::array<double, 32> height{};     ///< of the beams' origins [mm]

  std::size_t sequences() const { return 32 / lasers; }  ///< of a block
  double block_time() const { return static_cast<double>(sequences()) * sequence_time; }  ///< [ns]
};

/// The VLP-16, Puck Hi-Res, HDL-32E or VLP-32C; null for others.
const VelodyneModel* velodyne_model(std::uint8_t code);

/// "a VLS-128 (0xa1)"; of an unknown one the code alone.
std::string velodyne_name(std::uint8_t code);

}  // namespace aims
