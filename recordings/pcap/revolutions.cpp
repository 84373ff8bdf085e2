// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/pcap/revolutions.hpp"

#include <algorithm>
#include <utility>

namespace aims {
namespace {

constexpr int kRevolution = 36000;  ///< [0.01 deg]
constexpr int kLate = 3000;         ///< a smaller step back is no new revolution [0.01 deg]
constexpr std::size_t kMostEarly = 1'000'000;  ///< no sensor has as many returns in a turn

}  // namespace

std::optional<LidarScan> Revolutions::begin_block(int azimuth, int turn) {
  std::optional<LidarScan> ended;
  const int ahead = azimuth_ ? (azimuth - *azimuth_ + kRevolution) % kRevolution : 0;
  const bool late = ahead > kRevolution - kLate;
  // Of the revolution that has ended.
  overdue_ = late && azimuth > *azimuth_;
  block_ = azimuth;
  if (late) return ended;
  turned_ += ahead;
  if (turn_ > 0 && 2 * ahead > 3 * turn_) missed_ += ahead - turn_;
  if (azimuth_ && azimuth < *azimuth_) {
    if (whole_ && !scan_.points.empty()) ended = std::move(scan_);
    scan_ = LidarScan();
    whole_ = true;
  }
  if (ended) {
    ended_ = true;
    early_.clear();
  }
  // A recording that begins with a revolution has all of it.
  if (!azimuth_) whole_ = azimuth <= turn;
  azimuth_ = azimuth;
  turn_ = turn;
  return ended;
}

void Revolutions::add_to(LidarScan& scan, LidarPoint point, Time time) {
  if (scan.points.empty()) scan.stamp = time;
  point.time_offset_ns =
      static_cast<std::int32_t>(std::clamp<Duration>(time - scan.stamp, -kSecond, kSecond));
  scan.end = std::max(scan.end, time);
  scan.points.push_back(point);
}

void Revolutions::add(LidarPoint point, Time time) {
  if (overdue_) return;
  if (whole_) return add_to(scan_, point, time);
  if (!ended_ && early_.size() < kMostEarly) early_.push_back({block_, point, time});
}

/// The returns before the azimuth passed zero from where those behind it end.
std::optional<LidarScan> Revolutions::all_around() {
  if (ended_ || !whole_ || early_.empty() || !azimuth_) return std::nullopt;
  const int end = *azimuth_ + turn_;
  if (early_.front().azimuth > end) return std::nullopt;
  LidarScan scan;
  for (const Early& each : early_) {
    if (each.azimuth >= end) add_to(scan, each.point, each.time);
  }
  for (const LidarPoint& each : scan_.points) {
    add_to(scan, each, scan_.stamp + each.time_offset_ns);
  }
  return scan;
}

std::optional<LidarScan> Revolutions::finish() {
  const bool complete = whole_ && azimuth_ && *azimuth_ + 2 * turn_ >= kRevolution;
  auto around = complete ? std::nullopt : all_around();
  LidarScan scan = std::exchange(scan_, {});
  early_.clear();
  if (!complete) return around;
  if (scan.points.empty()) return std::nullopt;
  return scan;
}

}  // namespace aims
