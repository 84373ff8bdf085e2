// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "core/files/byte_cursor.hpp"
#include "recordings/pcap/ouster_packets.hpp"
#include "tests/fuzz/demand.hpp"
#include "tests/fuzz/fuzz_targets.hpp"
#include "tests/fuzz/memory_file.hpp"

namespace aims {

void fuzz_ouster(std::span<const std::uint8_t> input) {
  if (input.size() < sizeof(std::uint16_t)) return;
  auto bytes = std::as_bytes(input);
  const std::size_t length = load_number<std::uint16_t>(bytes.data());
  bytes = bytes.subspan(sizeof(std::uint16_t));
  const auto text = bytes.first(std::min(length, bytes.size()));
  const auto metadata = read_ouster_metadata(MemoryFile(text).path());
  if (!metadata) return demand_readable(metadata.error());
  bytes = bytes.subspan(text.size());
  OusterScans scans(*metadata);
  for (; bytes.size() >= scans.lidar_packet_size();
       bytes = bytes.subspan(scans.lidar_packet_size())) {
    const auto scan = scans.add(bytes.first(scans.lidar_packet_size()));
    if (!scan) continue;
    for (const LidarPoint& point : scan->points) {
      demand(point.position.allFinite() && point.ring < metadata->altitude_deg.size());
      demand(point.time_offset_ns >= 0 && scan->stamp + point.time_offset_ns <= scan->end);
    }
  }
  if (bytes.size() < OusterScans::kImuPacketSize) return;
  demand(OusterScans::imu_of(bytes.first(OusterScans::kImuPacketSize)).stamp >= 0);
}

}  // namespace aims
