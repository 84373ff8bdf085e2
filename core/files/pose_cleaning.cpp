// SPDX-License-Identifier: BSD-3-Clause
#include "core/files/pose_cleaning.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "core/median.hpp"

namespace aims {
namespace {

constexpr double kUnitTolerance = 1e-3;      ///< of a norm that is 1
constexpr double kRoundingTolerance = 0.06;  ///< of a norm from decimals that are rounded

enum Fault : std::size_t {
  kNoFault,
  kNotFinite,
  kNoRotation,
  kRepeated,
  kBackwards,
  kLost,
  kTooFar,
  kFaults
};

/// Beyond this a pose is not compared with the truth [m]; bench/metrics/association.cpp.
constexpr double kFarthest = 1e6;

Fault fault_of(const StampedPose& pose, const std::optional<Time>& last) {
  const Pose& each = pose.pose;
  if (!each.translation.allFinite() || !each.rotation.coeffs().allFinite()) return kNotFinite;
  if (!(std::abs(each.rotation.norm() - 1.0) < kUnitTolerance)) return kNoRotation;
  if (last && pose.stamp == *last) return kRepeated;
  return last && pose.stamp < *last ? kBackwards : kNoFault;
}

/// The pose that a motion capture writes where it lost the body.
bool is_unset(const Pose& pose) {
  return pose.translation.isZero(0.0) && pose.rotation.vec().isZero(0.0);
}

constexpr double kFar = 0.5;  ///< of a pose that is set from one that is not [m]

bool is_far(const Pose& pose) { return pose.translation.norm() > kFar; }

/// Whether the next pose that is set, from each on, is far from the origin, or there is none.
std::vector<bool> far_from(const Trajectory& poses) {
  std::vector<bool> far(poses.size());
  bool next = true;
  for (std::size_t i = poses.size(); i-- > 0;) {
    if (!is_unset(poses[i].pose)) next = is_far(poses[i].pose);
    far[i] = next;
  }
  return far;
}

/// Of the step to a pose from the one before [m/s].
double speed_to(const Trajectory& poses, std::size_t i) {
  const double time = to_seconds(poses[i].stamp - poses[i - 1].stamp);
  return (poses[i].pose.translation - poses[i - 1].pose.translation).norm() / time;
}

/// Whether the poses before the first that is set are none of a start: to that one is a leap, both
/// faster than robots are and than the steps behind it.
bool starts_lost(const Trajectory& poses, std::size_t first_set) {
  constexpr double kRobot = 6.0;  // [m/s]
  constexpr double kLeap = 3.0;   // times the median step
  if (first_set == 0 || first_set >= poses.size() || !is_far(poses[first_set].pose)) return false;
  std::vector<double> speeds;
  for (std::size_t i = first_set + 1; i < poses.size(); ++i) {
    if (!is_unset(poses[i].pose) && !is_unset(poses[i - 1].pose))
      speeds.push_back(speed_to(poses, i));
  }
  return speed_to(poses, first_set) >
         std::max(kRobot, kLeap * upper_median(std::move(speeds)).value_or(0.0));
}

/// Removes the unset poses between others that are far from the origin; yields how many.
std::size_t drop_lost(Trajectory& poses) {
  const auto set = std::ranges::find_if_not(poses, is_unset, &StampedPose::pose);
  bool before = starts_lost(poses, static_cast<std::size_t>(set - poses.begin()));
  const std::vector<bool> far = far_from(poses);
  Trajectory kept;
  kept.reserve(poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (before && far[i] && is_unset(poses[i].pose)) continue;
    before = is_far(poses[i].pose);
    kept.push_back(poses[i]);
  }
  const std::size_t lost = poses.size() - kept.size();
  poses = std::move(kept);
  return lost;
}

std::string text_of(const std::array<std::size_t, kFaults>& counts) {
  constexpr std::array<const char*, kFaults> kTexts = {
      "",
      "not finite",
      "without a unit quaternion",
      "with the stamp of the one before",
      "stamped before the one before",
      "exactly at the origin while those around are not",
      "more than 1000 km from the origin"};
  std::vector<std::string> parts;
  for (std::size_t i = kNotFinite; i < kFaults; ++i) {
    if (counts[i] > 0) parts.push_back(fmt::format("{} {}", counts[i], kTexts[i]));
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

}  // namespace

bool is_of_positions(Trajectory& poses, const std::string& name, std::vector<std::string>& notes) {
  const auto is_zero = [](const StampedPose& each) {
    return each.pose.rotation.coeffs().isZero(0.0);
  };
  if (poses.empty() || !std::ranges::all_of(poses, is_zero)) return false;
  for (StampedPose& each : poses) each.pose.rotation.setIdentity();
  notes.push_back(fmt::format("{}: all quaternions are zero: positions alone", name));
  return true;
}

void normalize_rounded(Trajectory& poses, const std::string& name,
                       std::vector<std::string>& notes) {
  std::size_t rounded = 0;
  double smallest = 1.0, largest = 1.0;
  for (StampedPose& each : poses) {
    const double norm = each.pose.rotation.norm();
    const double off = std::abs(norm - 1.0);
    if (!(off > kUnitTolerance && off <= kRoundingTolerance)) continue;
    each.pose.rotation.normalize();
    ++rounded;
    smallest = std::min(smallest, norm);
    largest = std::max(largest, norm);
  }
  if (rounded == 0) return;
  notes.push_back(
      fmt::format("{}: {} of {} quaternions have norms of {:.4g} to {:.4g}, as rounded "
                  "decimals do: normalized",
                  name, rounded, poses.size(), smallest, largest));
}

/// Puts poses in order that were written in another one, as by several threads. A single step back
/// is a recording that began anew.
void sort_shuffled(Trajectory& poses, const std::string& name, std::vector<std::string>& notes) {
  constexpr int kShuffled = 3;  // steps back
  int back = 0;
  for (std::size_t i = 1; i < poses.size(); ++i) back += poses[i].stamp < poses[i - 1].stamp;
  if (back < kShuffled) return;
  std::ranges::stable_sort(poses, {}, &StampedPose::stamp);
  notes.push_back(fmt::format("{}: stamps go back {} times: sorted by stamp", name, back));
}

std::string drop_unusable(Trajectory& poses, const std::string& name,
                          std::vector<std::string>& notes) {
  sort_shuffled(poses, name, notes);
  Trajectory usable;
  usable.reserve(poses.size());
  std::array<std::size_t, kFaults> counts{};
  std::optional<Time> last;
  for (const StampedPose& each : poses) {
    const Fault fault = fault_of(each, last);
    ++counts[fault];
    if (fault != kNoFault) continue;
    last = each.stamp;
    usable.push_back(each);
  }
  counts[kLost] = drop_lost(usable);
  std::string dropped;
  if (usable.size() < poses.size()) {
    dropped = fmt::format("{} of {} poses dropped: {}", poses.size() - usable.size(), poses.size(),
                          text_of(counts));
    notes.push_back(fmt::format("{}: {}", name, dropped));
  }
  if (counts[kRepeated] > usable.size() && usable.size() > 1) {
    notes.push_back(fmt::format(
        "{}: {} poses share {} stamps: stamps are rounded, and scores compare poses of other "
        "instants; write them with all digits",
        name, counts[kRepeated] + usable.size(), usable.size()));
  }
  poses = std::move(usable);
  return dropped;
}

std::string unusable_text(const Trajectory& poses) {
  std::array<std::size_t, kFaults> counts{};
  std::optional<Time> last;
  for (const StampedPose& each : poses) {
    Fault fault = fault_of(each, last);
    if (fault == kNoFault) last = each.stamp;
    if (fault == kNoFault && each.pose.translation.norm() >= kFarthest) fault = kTooFar;
    ++counts[fault];
  }
  return text_of(counts);
}

std::string leaps_text(const Trajectory& truth) {
  constexpr double kLeast = 0.3;         // [m]
  constexpr double kFastest = 15.0;      // [m/s]
  constexpr Duration kFrozen = kSecond;  // without any motion
  int leaps = 0;
  double largest = 0.0;
  Time at = 0, since = 0;
  Duration frozen = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const Eigen::Vector3d moved =
        i == 0 ? Eigen::Vector3d::Zero().eval()
               : (truth[i].pose.translation - truth[i - 1].pose.translation).eval();
    const bool moves = i == 0 || !moved.head<2>().isZero(0.0);
    const double step = i == 0 ? 0.0 : to_seconds(truth[i].stamp - truth[i - 1].stamp);
    if (moved.norm() > kLeast && moved.norm() > kFastest * step) {
      ++leaps;
      if (moved.norm() > largest) {
        at = truth[i].stamp;
        frozen = truth[i - 1].stamp - since;
      }
      largest = std::max(largest, moved.norm());
    }
    if (moves) since = truth[i].stamp;
  }
  if (leaps == 0) return "";
  return fmt::format(
      "positions jump {} times from one pose to the next, by up to {:.2f} m ({:.1f} "
      "s after its start{}): no robot moves so, and scores behind it are wrong",
      leaps, largest, to_seconds(at - truth.front().stamp),
      frozen > kFrozen ? fmt::format(", after they stood still for {:.1f} s", to_seconds(frozen))
                       : "");
}

}  // namespace aims
