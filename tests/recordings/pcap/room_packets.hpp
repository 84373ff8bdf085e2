// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/time.hpp"

namespace aims::test {

/// A packet of a LiDAR that spins at 10 Hz in the middle of a room of 8 x 6 x 3 m.
struct RoomPacket {
  Time time = 0;  ///< when it is sent
  std::vector<std::byte> payload;
};

inline constexpr double kRoom[3] = {4.0, 3.0, 1.5};  ///< half lengths [m]

/// Of a VLP-16 (user manual 63-9243) from azimuth 0 on; `start` is a whole number of microseconds.
std::vector<RoomPacket> vlp16_packets(Time start, int turns);

/// Of an HDL-32E, VLP-32C or Puck Hi-Res, by the tables of velodyne_pointcloud and VeloView.
struct VelodyneBeams {
  std::uint8_t code;
  std::vector<double> elevation, ahead;  ///< by laser; of the block's azimuth; clockwise [deg]
  double unit, cycle, firing;            ///< of a distance [m]; of all lasers, between them [us]
  std::size_t at_once = 1;               ///< lasers that fire together
};
VelodyneBeams hdl32e();
VelodyneBeams vlp32c();
VelodyneBeams puck_hi_res();
std::vector<RoomPacket> velodyne_packets(Time start, int turns, const VelodyneBeams& beams);

/// Of a Hesai with 32 or 16 lasers (XT32, XT16: user manuals, protocol 6.1) from azimuth 0 on,
/// which is 3.28 us after `start`, a whole number of microseconds.
std::vector<RoomPacket> xt_packets(Time start, int turns, int lasers = 32);

/// Of a RoboSense RS-LiDAR-16 (MSOP, as rs_driver reads it) from azimuth 0 on; `start` is a whole
/// number of microseconds. `tilt` [deg] is added to the elevations by a calibration.
struct Rs16 {
  bool dual = false;  ///< two returns: the second has a larger intensity, the first is shorter
  double tilt = 0.0;
};
std::vector<RoomPacket> rs16_packets(Time start, int turns, const Rs16& sensor = {});

/// Its packet of device information (DIFOP).
RoomPacket rs16_information(Time time, const Rs16& sensor);

/// Of an Ouster with 16 beams and 512 columns (profile LEGACY), whose clock begins at `clock`.
std::vector<RoomPacket> ouster_lidar_packets(Time start, Time clock, int turns);
std::vector<RoomPacket> ouster_imu_packets(Time start, Time clock, int packets);
std::string ouster_metadata_text();

}  // namespace aims::test
