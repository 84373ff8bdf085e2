// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace aims {

/// The LiDAR that sends such a packet of points, with its article: "a Pandar40P". By its first
/// bytes and its size, as the drivers of the makers tell them; empty for none that is known.
std::string lidar_of_packet(std::span<const std::byte> payload);

/// The same of a Hesai's packet that begins with 0xee 0xff; "a Hesai of protocol 9, 40 lasers" for
/// an unknown one.
std::string hesai_of_packet(std::span<const std::byte> payload);

/// The same of a RoboSense by the model in its packet.
std::string robosense_of_model(int model);

}  // namespace aims
