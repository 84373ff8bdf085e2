// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/clouds/turn_parts.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/median.hpp"

namespace aims {
namespace {

constexpr double kFullTurn = 2.0 * std::numbers::pi;
constexpr int kFewestPoints = 5;          ///< of a cloud whose middle is known
constexpr std::size_t kFewestClouds = 6;  ///< that show parts
constexpr double kMostOfTurn =
    0.56 * kFullTurn;  ///< that a part covers: half a turn and its borders
constexpr double kLeastSeen = 0.25 * kFullTurn;  ///< that the steps add up to
constexpr double kLeastStep = 0.5;               ///< of what a part covers
constexpr double kSame = 0.5;                    ///< by which steps differ, as a fraction
constexpr double kMostly = 0.8;                  ///< of the steps

/// The angle from 0 to a turn.
double within_turn(double angle) { return angle - kFullTurn * std::floor(angle / kFullTurn); }

/// The angle from minus half a turn to half a turn.
double signed_turn(double angle) { return within_turn(angle + 0.5 * kFullTurn) - 0.5 * kFullTurn; }

/// The most neighbours on a circle that are not set.
template <std::size_t kSize>
std::size_t longest_gap(const std::bitset<kSize>& seen) {
  std::size_t longest = 0, gap = 0;
  for (std::size_t i = 0; i < 2 * kSize; ++i) {
    gap = seen[i % kSize] ? 0 : gap + 1;
    longest = std::max(longest, gap);
  }
  return std::min(longest, kSize);
}

/// The middle of the azimuths of the returns; nothing of too few.
std::optional<double> middle_of(const LidarScan& scan) {
  Eigen::Vector2f sum = Eigen::Vector2f::Zero();
  if (std::ssize(scan.points) < kFewestPoints) return std::nullopt;
  for (const LidarPoint& each : scan.points) sum += each.position.head<2>().normalized();
  return std::atan2(static_cast<double>(sum.y()), static_cast<double>(sum.x()));
}

}  // namespace

void TurnPartFinder::begin() { clouds_.emplace_back(); }

void TurnPartFinder::add(const Eigen::Vector3d& position) {
  const double distance = position.head<2>().norm();
  if (!(distance > 0.0)) return;
  Cloud& cloud = clouds_.back();
  const double azimuth = within_turn(std::atan2(position.y(), position.x()));
  const auto bin = static_cast<std::size_t>(azimuth / kFullTurn * static_cast<double>(kBins));
  cloud.seen.set(std::min(bin, kBins - 1));
  cloud.sum += position.head<2>() / distance;
  ++cloud.points;
}

TurnParts TurnPartFinder::find() const {
  std::vector<double> covered, steps, sizes;
  std::optional<double> before;
  for (const Cloud& each : clouds_) {
    if (each.points < kFewestPoints) continue;
    covered.push_back(kFullTurn * static_cast<double>(each.seen.count()) /
                      static_cast<double>(kBins));
    const double middle = std::atan2(each.sum.y(), each.sum.x());
    if (before) {
      steps.push_back(signed_turn(middle - *before));
      sizes.push_back(std::abs(steps.back()));
    }
    before = middle;
  }
  if (covered.size() < kFewestClouds) return {};
  const double size = *upper_median(sizes), part = *upper_median(covered);
  if (part > kMostOfTurn || size < kLeastStep * part) return {};
  double sum = 0.0;
  for (const double each : steps) sum += each;
  const double sense = sum < 0.0 ? -1.0 : 1.0;
  const bool halves = size > 0.4 * kFullTurn;  // of which either side is beside
  const auto alike = std::ranges::count_if(steps, [&](double each) {
    const double step = halves ? std::abs(each) : sense * each;
    return std::abs(step - size) < kSame * size;
  });
  const bool steady = static_cast<double>(alike) >= kMostly * static_cast<double>(steps.size());
  if (!steady || size * static_cast<double>(steps.size()) < kLeastSeen) return {};
  const int count = std::max(2, static_cast<int>(std::lround(kFullTurn / size)));
  return {count, sense * kFullTurn / count};
}

double TurnPartFinder::blind_part() const {
  std::vector<double> parts;
  for (const Cloud& each : clouds_) {
    parts.push_back(static_cast<double>(longest_gap(each.seen)) / static_cast<double>(kBins));
  }
  return upper_median(parts).value_or(0.0);
}

TurnJoiner::TurnJoiner(const TurnParts& parts, Duration period)
    : parts_(parts), longest_(period * parts.count * 3 / 2) {}

void TurnJoiner::begin(const LidarScan& part) {
  turn_ = part;
  turned_ = 0.0;
  begun_ = true;
}

std::optional<LidarScan> TurnJoiner::add(const LidarScan& part) {
  const auto middle = middle_of(part);
  if (!middle) return std::nullopt;
  const double before = std::exchange(middle_, *middle);
  const Duration since = part.stamp - turn_.stamp;
  if (!begun_ || since < 0 || since > longest_) {
    begin(part);
    return std::nullopt;
  }
  const double step = std::abs(parts_.step);
  const double ahead = parts_.step < 0.0 ? before - *middle : *middle - before;
  turned_ += within_turn(ahead + 0.5 * step) - 0.5 * step;  // one that comes late goes back
  for (LidarPoint point : part.points) {
    point.time_offset_ns = static_cast<std::int32_t>(point.time_offset_ns + since);
    turn_.points.push_back(point);
  }
  turn_.end = std::max(turn_.end, part.end);
  if (turned_ + 1.5 * step < kFullTurn) return std::nullopt;
  begun_ = false;
  return std::move(turn_);
}

}  // namespace aims
