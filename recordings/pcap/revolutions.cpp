// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/pcap/revolutions.hpp"

#include <algorithm>
#include <utility>

namespace aims {

std::optional<LidarScan> Revolutions::begin_block(int azimuth, int turn) {
  std::optional<LidarScan> ended;
  if (azimuth_ && azimuth < *azimuth_) {
    if (whole_ && !scan_.points.empty()) ended = std::move(scan_);
    scan_ = LidarScan();
    whole_ = true;
  }
  // A recording that begins with a revolution has all of it.
  if (!azimuth_) whole_ = azimuth <= turn;
  azimuth_ = azimuth;
  turn_ = turn;
  return ended;
}

void Revolutions::add(LidarPoint point, Time time) {
  if (scan_.points.empty()) scan_.stamp = time;
  point.time_offset_ns =
      static_cast<std::int32_t>(std::clamp<Duration>(time - scan_.stamp, -kSecond, kSecond));
  scan_.end = std::max(scan_.end, time);
  scan_.points.push_back(point);
}

std::optional<LidarScan> Revolutions::finish() {
  constexpr int kFullTurn = 36000;  // [0.01 deg]
  const bool complete = whole_ && azimuth_ && *azimuth_ + 2 * turn_ >= kFullTurn;
  LidarScan scan = std::exchange(scan_, {});
  if (!complete || scan.points.empty()) return std::nullopt;
  return scan;
}

}  // namespace aims
