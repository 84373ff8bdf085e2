// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scoring/score_hints.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "bench/metrics/absolute_error.hpp"
#include "bench/metrics/alignment.hpp"
#include "core/text.hpp"

namespace aims {
namespace {

constexpr std::array<std::pair<const char*, double>, 3> kUnits = {
    {{"ms", 1e3}, {"us", 1e6}, {"ns", 1e9}}};

constexpr std::size_t kFewestPairs = 10;
constexpr double kTurned = 10.0;     ///< of the body frame [deg]
constexpr double kScatter = 5.0;     ///< most of the rotations about their mean, median [deg]
constexpr double kWellFit = 0.1;     ///< ATE as a fraction of the spread of the true positions
constexpr double kLevel = 0.87;      ///< cosine of 30 deg, by which worlds may be inclined
constexpr double kRightAngle = 3.0;  ///< from a multiple of 90 deg that is meant [deg]

double degrees(double radians) { return radians * 180.0 / std::numbers::pi; }

/// From the first stamp to the last [s].
double span_of(const Trajectory& trajectory) {
  const auto by_stamp = [](const StampedPose& a, const StampedPose& b) {
    return a.stamp < b.stamp;
  };
  const auto [first, last] = std::ranges::minmax_element(trajectory, by_stamp);
  return static_cast<double>(last->stamp) * 1e-9 - static_cast<double>(first->stamp) * 1e-9;
}

/// Root mean square distance of the positions of one side from their mean [m].
double spread_of(std::span<const PosePair> pairs, Pose PosePair::*side) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const PosePair& each : pairs)
    mean += (each.*side).translation / static_cast<double>(pairs.size());
  double sum = 0.0;
  for (const PosePair& each : pairs) sum += ((each.*side).translation - mean).squaredNorm();
  return std::sqrt(sum / static_cast<double>(pairs.size()));
}

/// The estimate aligned so that its attitude can be compared; empty where positions do not tell.
std::vector<PosePair> compared(std::span<const PosePair> pairs, const ScoreConfig& config) {
  const bool is_level = config.anchor == AlignmentKind::kStartHeading;
  const Alignment alignment = is_level ? align_yaw(pairs) : align_se3(pairs);
  if (!is_level && alignment.spread != PositionSpread::kFull) return {};
  return aligned(std::vector<PosePair>(pairs.begin(), pairs.end()), alignment);
}

/// The rotation of the body frame with the least median distance to all of them: a medoid of some.
Eigen::Quaterniond middle_of(const std::vector<Eigen::Quaterniond>& rotations, double& scatter) {
  constexpr std::size_t kTried = 50;
  Eigen::Quaterniond best = rotations.front();
  scatter = 1e9;
  const std::size_t step = std::max<std::size_t>(1, rotations.size() / kTried);
  for (std::size_t i = 0; i < rotations.size(); i += step) {
    std::vector<double> distances;
    for (const auto& each : rotations) distances.push_back(each.angularDistance(rotations[i]));
    const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
    std::ranges::nth_element(distances, middle);
    if (*middle >= scatter) continue;
    scatter = *middle;
    best = rotations[i];
  }
  return best;
}

/// Snapped to right angles where all three are meant: a mount as it was drawn, not as it errs.
Eigen::Quaterniond snapped(const Eigen::Quaterniond& rotation) {
  const Eigen::Matrix3d nearest = rotation.toRotationMatrix().array().round();
  if (std::abs(nearest.determinant() - 1.0) > 1e-9) return rotation;
  const Eigen::Quaterniond right(nearest);
  return degrees(right.angularDistance(rotation)) <= kRightAngle ? right : rotation;
}

/// "90 deg about z", "120 deg about [0.58, 0.58, 0.58]".
std::string turn_text(const Eigen::Quaterniond& rotation) {
  const Eigen::AngleAxisd turn(rotation);
  Eigen::Vector3d axis = turn.axis();
  double angle = degrees(turn.angle());
  Eigen::Index along = 0;
  if (axis.cwiseAbs().maxCoeff(&along) > 0.999) {
    if (axis[along] < 0.0) angle = -angle;
    return fmt::format("{:.3g} deg about {}", angle, "xyz"[along]);
  }
  return fmt::format("{:.3g} deg about [{}, {}, {}]", angle, decimal_text(axis.x(), 2),
                     decimal_text(axis.y(), 2), decimal_text(axis.z(), 2));
}

/// "x y z qx qy qz qw" without negative zeros and what rounding leaves.
std::string extrinsic_text(const Pose& pose) {
  const Eigen::Vector3d& t = pose.translation;
  const Eigen::Vector4d& q = pose.rotation.coeffs();
  std::vector<std::string> numbers;
  for (const double each : {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()}) {
    numbers.push_back(fmt::format("{:.4g}", std::abs(each) < 5e-5 ? 0.0 : each));
  }
  return fmt::format("{}", fmt::join(numbers, " "));
}

/// Another meaning of the four numbers of a quaternion.
struct QuaternionReading {
  Eigen::Quaterniond (*read)(const Eigen::Quaterniond&);
  const char* text;
};

constexpr std::array<QuaternionReading, 2> kReadings = {
    {{[](const Eigen::Quaterniond& q) { return Eigen::Quaterniond(q.x(), q.y(), q.z(), q.w()); },
      "are read as w, x, y, z: expected x, y, z, w"},
     {[](const Eigen::Quaterniond& q) { return q.conjugate(); },
      "are conjugated, as those from the world to the body or of JPL's convention: expected those "
      "from the body to the world"}}};

/// Whether positions fit well and within `most` metres, with any rotation between the worlds.
bool fits(const std::vector<PosePair>& pairs, double most) {
  const Alignment alignment = align_se3(pairs);
  if (alignment.spread != PositionSpread::kFull) return false;
  const auto error = ate_rmse(aligned(pairs, alignment));
  return error && *error < most && *error < kWellFit * spread_of(pairs, &PosePair::truth);
}

/// Of attitudes that fit only when the numbers of one side mean something else. `aligned`: the
/// same pairs with the estimate aligned by its positions.
std::optional<std::string> quaternion_hint(std::span<const PosePair> pairs,
                                           std::span<const PosePair> aligned, double scatter) {
  if (degrees(scatter) <= kScatter) return std::nullopt;
  const Eigen::Quaterniond Q =
      aligned.front().estimate.rotation * pairs.front().estimate.rotation.conjugate();
  for (const QuaternionReading& reading : kReadings) {
    std::vector<std::string> fitting;
    for (const bool of_truth : {true, false}) {
      std::vector<Eigen::Quaterniond> rotations;
      for (const PosePair& each : pairs) {
        const Eigen::Quaterniond& truth = each.truth.rotation;
        const Eigen::Quaterniond& estimate = each.estimate.rotation;
        rotations.push_back(of_truth ? reading.read(truth).conjugate() * (Q * estimate)
                                     : truth.conjugate() * (Q * reading.read(estimate)));
      }
      double other = 0.0;
      middle_of(rotations, other);
      if (degrees(other) > kScatter || 3.0 * other > scatter) continue;
      fitting.emplace_back(of_truth ? "the truth's" : "its");
    }
    if (fitting.empty()) continue;
    // Of a motion in the plane either side may be the one.
    return fmt::format("the attitudes fit where {} quaternions {}", fmt::join(fitting, " or "),
                       reading.text);
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> stamp_unit_hint(const Trajectory& estimate, const Trajectory& truth) {
  if (estimate.size() < 2 || truth.size() < 2) return std::nullopt;
  const double ratio = span_of(estimate) / span_of(truth);
  for (const auto& [unit, factor] : kUnits) {
    const auto is_about = [](double value) { return value > 0.3 && value < 1.5; };
    if (is_about(ratio / factor)) {
      return fmt::format(
          "its stamps span {:.3g} times the truth's: likely in {}, which --stamp-unit {} reads",
          ratio, unit, unit);
    }
    if (is_about(1.0 / (ratio * factor))) {
      return fmt::format(
          "the truth's stamps span {:.3g} times its own: likely in {}; expected seconds",
          1.0 / ratio, unit);
    }
  }
  return std::nullopt;
}

bool is_frame_index(const Trajectory& poses) {
  constexpr std::size_t kFewest = 3;
  if (poses.size() < kFewest || poses.front().stamp > kSecond) return false;
  Time last = -kSecond;
  return std::ranges::all_of(poses, [&last](const StampedPose& each) {
    const bool next = each.stamp % kSecond == 0 && each.stamp > last;
    last = each.stamp;
    return next && each.stamp >= 0;
  });
}

std::optional<std::string> frame_index_hint(const Trajectory& estimate, const Trajectory& truth) {
  constexpr double kLonger = 2.0;  // frames are more than seconds
  constexpr double kAlike = 0.1;   // of spans of the same route, at one pose a second
  const bool of_estimate = is_frame_index(estimate);
  if (of_estimate == is_frame_index(truth) || truth.size() < 2) return std::nullopt;
  const Trajectory& frames = of_estimate ? estimate : truth;
  const Trajectory& timed = of_estimate ? truth : estimate;
  const auto [first, last] = std::ranges::minmax_element(timed, {}, &StampedPose::stamp);
  const bool apart = frames.back().stamp < first->stamp || frames.front().stamp > last->stamp;
  const double ratio = span_of(frames) / span_of(timed);
  const bool seconds = of_estimate ? std::abs(ratio - 1.0) < kAlike : ratio < kLonger;
  if (apart ? seconds : ratio < kLonger) return std::nullopt;
  return fmt::format(
      "{} stamps are the whole numbers from {} to {}, likely numbers of frames: expected seconds "
      "on the clock of the {}; --times FILE, with the stamp of each frame in a line, gives them",
      of_estimate ? "its" : "the truth's", frames.front().stamp / kSecond,
      frames.back().stamp / kSecond, of_estimate ? "truth" : "estimate");
}

std::optional<std::string> frozen_truth_hint(const Trajectory& truth,
                                             std::span<const Trajectory* const> estimates) {
  constexpr Duration kLeast = 2 * kSecond;
  constexpr double kSame = 1e-9, kMoves = 0.5;  // [m]
  if (truth.empty() || estimates.empty()) return std::nullopt;
  const Eigen::Vector3d place = truth.back().pose.translation;
  const auto moves = [&place](const StampedPose& each) {
    return (each.pose.translation - place).norm() > kSame;
  };
  const auto before = std::ranges::find_if(truth.rbegin(), truth.rend(), moves);
  if (before == truth.rbegin() || before == truth.rend()) return std::nullopt;
  const Time since = before.base()->stamp, end = truth.back().stamp;
  if (end - since < kLeast) return std::nullopt;
  double least = std::numeric_limits<double>::max();
  for (const Trajectory* each : estimates) {
    double farthest = 0.0;
    std::optional<Eigen::Vector3d> first;
    for (const StampedPose& pose : *each) {
      if (pose.stamp < since || pose.stamp > end || !pose.pose.translation.allFinite()) continue;
      if (!first) first = pose.pose.translation;
      farthest = std::max(farthest, (pose.pose.translation - *first).norm());
    }
    least = std::min(least, farthest);
  }
  if (least < kMoves) return std::nullopt;
  return fmt::format(
      "it repeats one pose from {:.1f} s after its start to its end, for {:.1f} s, while the "
      "estimates move by {:.2f} m or more: a motion capture that lost the body, or a recording "
      "of it that ended; scores from there on are wrong",
      to_seconds(since - truth.front().stamp), to_seconds(end - since), least);
}

std::optional<std::string> position_unit_hint(const Trajectory& estimate, const Trajectory& truth,
                                              const ScoreConfig& config) {
  auto pairs = compared_pairs(valid_part(estimate), truth, config);
  if (pairs.size() < kFewestPairs) return std::nullopt;
  const double ratio = spread_of(pairs, &PosePair::estimate) / spread_of(pairs, &PosePair::truth);
  const auto factor_of = [ratio](double factor) { return ratio > 1.0 ? factor : 1.0 / factor; };
  for (const auto& [unit, factor] : {std::pair{"mm", 1e3}, {"cm", 1e2}}) {
    if (std::abs(ratio / factor_of(factor) - 1.0) > kWellFit) continue;
    for (PosePair& each : pairs) each.estimate.translation /= factor_of(factor);
    // One that has lost its way is of no other unit.
    const auto error = ate_rmse(compared(pairs, config));
    if (!error || !(*error < kWellFit * spread_of(pairs, &PosePair::truth))) return std::nullopt;
    return fmt::format("{} positions spread {:.3g} times {}: likely in {}; expected metres",
                       ratio > 1.0 ? "its" : "the truth's", std::max(ratio, 1.0 / ratio),
                       ratio > 1.0 ? "the truth's" : "its own", unit);
  }
  return std::nullopt;
}

std::optional<std::string> world_hint(const Trajectory& estimate, const Trajectory& truth,
                                      const ScoreConfig& config) {
  constexpr double kBetter = 0.1;  // of the error
  const auto pairs = compared_pairs(valid_part(estimate), truth, config);
  if (pairs.size() < kFewestPairs) return std::nullopt;
  const auto error = ate_rmse(compared(pairs, config));
  if (!error) return std::nullopt;
  const double enough = kBetter * *error;
  if (const Alignment free = align_se3(pairs); fits(pairs, enough)) {
    const Eigen::Quaterniond turn = snapped(free.T_truth_estimate.rotation);
    const bool level = (turn * Eigen::Vector3d::UnitZ()).z() > kLevel;
    if (level) return std::nullopt;
    return fmt::format(
        "positions fit {:.0f} times better once its world is turned by {}: the worlds have other "
        "axes (z down as in NED, of a camera, left-handed), expected z up and right-handed in both",
        1.0 / kBetter, turn_text(turn));
  }
  auto inverse = pairs, mirrored = pairs;
  for (PosePair& each : inverse) each.truth = each.truth.inverse();
  for (PosePair& each : mirrored) each.truth.translation.y() *= -1.0;
  if (config.truth != TruthContent::kPosition && fits(inverse, enough)) {
    return "positions fit ten times better with the inverse of the truth's poses: expected those "
           "of the body in the world, in truth and estimate";
  }
  if (!fits(mirrored, enough)) return std::nullopt;
  return "positions fit ten times better with one axis mirrored: one world is left-handed, "
         "expected right-handed ones";
}

std::optional<std::string> body_frame_hint(const Trajectory& estimate, const Trajectory& truth,
                                           const Pose& T_body_estimate, const ScoreConfig& config) {
  if (config.truth == TruthContent::kPosition) return std::nullopt;
  const auto pairs = compared_pairs(valid_part(estimate), truth, config);
  if (pairs.size() < kFewestPairs) return std::nullopt;
  const auto best = compared(pairs, config);
  const auto error = ate_rmse(best);
  if (!error || !(*error < kWellFit * spread_of(pairs, &PosePair::truth))) return std::nullopt;
  std::vector<Eigen::Quaterniond> rotations;
  for (const PosePair& each : best) {
    rotations.push_back(each.truth.rotation.conjugate() * each.estimate.rotation);
  }
  double scatter = 0.0;
  const Eigen::Quaterniond middle = middle_of(rotations, scatter);
  if (auto order = quaternion_hint(pairs, best, scatter)) return order;
  const double turned = degrees(middle.angularDistance(Eigen::Quaterniond::Identity()));
  if (turned < kTurned || degrees(scatter) > kScatter) return std::nullopt;
  const Eigen::Quaterniond turn = snapped(middle);
  const Pose option = Pose{turn, Eigen::Vector3d::Zero()} * T_body_estimate;
  return fmt::format(
      "its body frame is turned by {} against the truth's: --extrinsic '{}' takes it to the "
      "truth's (the ATE aligned by heading does not depend on it; heading error, RPE and ATE from "
      "the start do)",
      turn_text(turn), extrinsic_text(option));
}

}  // namespace aims
