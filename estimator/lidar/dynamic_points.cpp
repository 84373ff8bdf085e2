// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/lidar/dynamic_points.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

namespace aims {
namespace {

/// Ages of the scans compared with: what walks at 0.6 m/s or faster moves by the margin within the
/// first, a slow walker within the second.
constexpr std::array kAges = {kSecond / 2, kSecond};
/// A scan stands for an age when it is at most this much older, or a tenth of it younger.
constexpr Duration kMaxOlder = kSecond / 2;
constexpr Duration kMaxYounger = kSecond / 20;

/// How far a scan must have passed a point [m]: more than noise, than the drift of a pose within a
/// second, and than the depth of most recesses.
constexpr float kMargin = 0.3F;
/// How near an earlier return must be to confirm one [m].
constexpr float kTolerance = 0.5F * kMargin;

/// Edge of a column [m]: about half a person.
constexpr float kColumn = 0.3F;
/// Pixels of a column that show movement, at least: single ones may be thin edges between rings.
constexpr float kMinVotes = 3.0F;
/// Times the distance of the column [m], likewise: a tenth of the pixels that one as high as a
/// person fills. A few pixels at the jambs of near doors come and go by parallax.
constexpr float kMinVotesTimesDistance = 16.0F;
/// Columns around what came that may belong to it: 0.6 m.
constexpr int kReachOfCame = 2;
/// Columns around what went where it may be now: as far as it walks within a second, 1.2 m.
constexpr int kReachOfWent = 4;

}  // namespace

int DynamicPoints::Columns::cell_of(const Eigen::Vector3f& point) {
  constexpr float kHalf = 0.5F * static_cast<float>(kSide);
  const float x = point.x() / kColumn + kHalf;
  const float y = point.y() / kColumn + kHalf;
  constexpr auto kEnd = static_cast<float>(kSide);
  if (!(x >= 0.0F && y >= 0.0F && x < kEnd && y < kEnd)) return -1;
  return static_cast<int>(y) * kSide + static_cast<int>(x);
}

/// Votes by which column `x`, `y` shows movement.
float DynamicPoints::Columns::min_votes(int x, int y) {
  const Eigen::Vector2f from_corner(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F);
  const Eigen::Vector2f center = from_corner.array() - 0.5F * static_cast<float>(kSide);
  return std::max(kMinVotes, kMinVotesTimesDistance / (kColumn * center.norm()));
}

void DynamicPoints::Columns::clear() {
  for (int cell : used_) cells_[static_cast<std::size_t>(cell)] = 0;
  used_.clear();
}

void DynamicPoints::Columns::add(int cell) {
  std::uint8_t& votes = cells_[static_cast<std::size_t>(cell)];
  if (votes == 0) used_.push_back(cell);
  if (votes < std::numeric_limits<std::uint8_t>::max()) ++votes;
}

void DynamicPoints::Columns::vote(const FourPoints& points, unsigned lanes) {
  for (; lanes != 0; lanes &= lanes - 1) {
    const int cell = cell_of(points.point(static_cast<std::size_t>(std::countr_zero(lanes))));
    if (cell >= 0) add(cell);
  }
}

void DynamicPoints::Columns::mark_around(int reach, Columns& marks) const {
  for (int cell : used_) {
    const int x = cell % kSide;
    const int y = cell / kSide;
    if (cells_[static_cast<std::size_t>(cell)] < min_votes(x, y)) continue;
    for (int j = std::max(y - reach, 0); j <= std::min(y + reach, kSide - 1); ++j) {
      for (int i = std::max(x - reach, 0); i <= std::min(x + reach, kSide - 1); ++i) {
        const int squared = (i - x) * (i - x) + (j - y) * (j - y);
        if (squared <= reach * reach + 1) marks.add(j * kSide + i);
      }
    }
  }
}

bool DynamicPoints::Columns::marked(const Eigen::Vector3f& point) const {
  const int cell = cell_of(point);
  return cell >= 0 && cells_[static_cast<std::size_t>(cell)] > 0;
}

DynamicPoints::DynamicPoints(const Eigen::Vector3d& lever) : lever_(lever) {}

Pose DynamicPoints::lidar_pose(const Pose& T_odom_body) const {
  Pose T_odom_lidar = T_odom_body;
  T_odom_lidar.translation = T_odom_body * lever_;
  return T_odom_lidar;
}

/// The newest scan of each age.
void DynamicPoints::find_references() {
  references_.clear();
  for (Duration age : kAges) {
    const auto younger = [&](const Past& each) {
      return now_.stamp - each.stamp < age - kMaxYounger;
    };
    const auto end = std::ranges::find_if(past_, younger);
    if (end == past_.begin()) continue;
    const Past& past = *std::prev(end);
    if (now_.stamp - past.stamp > age + kMaxOlder) continue;
    const Pose T_past_now = past.T_odom_lidar.inverse() * now_.T_odom_lidar;
    references_.push_back(
        {&past, T_past_now.R().cast<float>(), T_past_now.translation.cast<float>()});
  }
}

/// Bit i: whether an earlier scan passed point i.
unsigned DynamicPoints::came(const FourPoints& points) const {
  unsigned lanes = 0;
  for (const Reference& each : references_) {
    lanes |= each.past->image.passed(each.to_past(points), kMargin);
  }
  return lanes;
}

bool DynamicPoints::confirmed(const Eigen::Vector3f& point) const {
  return std::ranges::all_of(references_, [&](const Reference& each) {
    return each.past->image.confirms(each.R_past_now * point + each.t_past_now, kTolerance);
  });
}

void DynamicPoints::compare(const PointBlocks& points, Time stamp, const Pose& T_odom_body) {
  from_lidar_ = points;
  from_lidar_.subtract(lever_.cast<float>());
  now_.stamp = stamp;
  now_.image.fill(from_lidar_);
  now_.T_odom_lidar = lidar_pose(T_odom_body);
  find_references();
  came_.clear();
  went_.clear();
  marks_.clear();
  const PointBlocks& present = now_.image.nearest();
  for (std::size_t i = 0; i < present.block_count(); ++i) {
    came_.vote(present.block(i), came(present.block(i)));
  }
  for (const Reference& each : references_) {
    const PointBlocks& earlier = each.past->image.nearest();
    for (std::size_t i = 0; i < earlier.block_count(); ++i) {
      const FourPoints seen_then = each.to_now(earlier.block(i));
      went_.vote(seen_then, now_.image.passed(seen_then, kMargin));
    }
  }
  came_.mark_around(kReachOfCame, marks_);
  went_.mark_around(kReachOfWent, marks_);
}

int DynamicPoints::remove_from(std::vector<Eigen::Vector3f>& points) const {
  if (!marks_.any()) return 0;
  const Eigen::Vector3f lever = lever_.cast<float>();
  const auto moves = [&](const Eigen::Vector3f& point) {
    const Eigen::Vector3f from_lidar = point - lever;
    return marks_.marked(from_lidar) && !confirmed(from_lidar);
  };
  return static_cast<int>(std::erase_if(points, moves));
}

void DynamicPoints::keep(const Pose& T_odom_body) {
  now_.T_odom_lidar = lidar_pose(T_odom_body);
  past_.push_back(std::move(now_));
  if (past_.back().stamp - past_.front().stamp > kAges.back() + kMaxOlder) {
    now_ = std::move(past_.front());
    past_.erase(past_.begin());
  } else {
    now_ = Past();
  }
}

}  // namespace aims
