// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scoring/motion_offset.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "bench/metrics/association.hpp"

namespace aims {
namespace {

constexpr Duration kWindow = kSecond;     ///< that a speed is taken over
constexpr Duration kGrid = kSecond / 10;  ///< at least
constexpr Duration kOverlap = 5 * kSecond;
constexpr Duration kBeside = 2 * kSecond;  ///< farther off, another offset is no part of the peak
constexpr std::size_t kMostSpeeds = 2000;
constexpr double kFinest = 1e-3;  ///< step of the search [s]
constexpr double kLeastCorrelation = 0.9;
constexpr double kLeastLead = 0.05;       ///< in correlation, over other offsets
constexpr double kLeastDeviation = 0.02;  ///< of the speeds [m/s]
constexpr double kLeastOffset = 0.2;      ///< of a hint [s]
constexpr double kCommon = 0.9;           ///< of the shorter one at the offset: one walk, not two
constexpr double kExplained = 0.5;        ///< of what the speeds lack to a correlation of 1

/// The mean speed over `window` from that time on [m/s]; none where the poses do not cover it.
std::optional<double> speed_from(const Trajectory& poses, Time at, Duration window) {
  const auto from = pose_at(poses, at);
  const auto to = pose_at(poses, at + window);
  if (!from || !to) return std::nullopt;
  return (to->translation - from->translation).norm() / to_seconds(window);
}

/// The speed from each point of the grid on [m/s]; a coarse grid has longer windows, which leave
/// nothing out between its points.
std::vector<double> speeds_of(const Trajectory& poses, Duration grid) {
  std::vector<double> speeds;
  const Duration window = std::max(kWindow, grid);
  const Time end = poses.back().stamp - window;
  for (Time at = poses.front().stamp; at <= end; at += grid) {
    const auto speed = speed_from(poses, at, window);
    if (!speed) break;
    speeds.push_back(*speed);
  }
  return speeds;
}

/// The correlation of `a[i]` with `b[i + lag]` over what they have in common; 0 where either is
/// nearly constant.
double correlation_at(const std::vector<double>& a, const std::vector<double>& b,
                      std::ptrdiff_t lag) {
  const std::ptrdiff_t begin = std::max<std::ptrdiff_t>(0, -lag);
  const std::ptrdiff_t end = std::min(std::ssize(a), std::ssize(b) - lag);
  double sum_a = 0.0, sum_b = 0.0, aa = 0.0, bb = 0.0, ab = 0.0;
  for (std::ptrdiff_t i = begin; i < end; ++i) {
    const double x = a[static_cast<std::size_t>(i)];
    const double y = b[static_cast<std::size_t>(i + lag)];
    sum_a += x;
    sum_b += y;
    aa += x * x;
    bb += y * y;
    ab += x * y;
  }
  const auto count = static_cast<double>(end - begin);
  const double variance_a = aa / count - sum_a * sum_a / (count * count);
  const double variance_b = bb / count - sum_b * sum_b / (count * count);
  const double least = kLeastDeviation * kLeastDeviation;
  if (variance_a < least || variance_b < least) return 0.0;
  return (ab / count - sum_a * sum_b / (count * count)) / std::sqrt(variance_a * variance_b);
}

/// Where the parabola through three values a step apart has its top, in steps from the middle one.
double top_of(double before, double at, double after) {
  const double curvature = before - 2.0 * at + after;
  return curvature < 0.0 ? 0.5 * (before - after) / curvature : 0.0;
}

/// The correlation of the estimate's speeds, on a grid of `kGrid`, with the true ones at that
/// offset; 0 where they have nothing in common.
double correlation_of(const std::vector<double>& speeds, Time first, const Trajectory& true_poses,
                      double offset) {
  std::vector<double> ours, theirs;
  for (std::size_t i = 0; i < speeds.size(); ++i) {
    const Time at = first + static_cast<Time>(i) * kGrid + from_seconds(offset);
    const auto speed = speed_from(true_poses, at, kWindow);
    if (!speed) continue;
    ours.push_back(speeds[i]);
    theirs.push_back(*speed);
  }
  return ours.empty() ? 0.0 : correlation_at(ours, theirs, 0);
}

/// Of the offsets within `half` of `about` at which the estimate's speeds, on a grid of `kGrid`,
/// correlate best with the true ones: the best one.
MotionOffset refined(const Trajectory& poses, const Trajectory& true_poses, double about,
                     double half) {
  const std::vector<double> speeds = speeds_of(poses, kGrid);
  const auto correlation = [&](double offset) {
    return correlation_of(speeds, poses.front().stamp, true_poses, offset);
  };
  MotionOffset best{about, correlation(about)};
  const auto try_at = [&](double offset) {
    if (const double at = correlation(offset); at > best.correlation) best = {offset, at};
  };
  const double grid = to_seconds(kGrid);
  for (double beside = grid; beside <= half; beside += grid) {
    try_at(about - beside);
    try_at(about + beside);
  }
  for (double step = grid / 2.0; step > kFinest; step /= 2.0) {
    const double middle = best.seconds;
    try_at(middle - step);
    try_at(middle + step);
  }
  return best;
}

}  // namespace

std::optional<MotionOffset> motion_offset(const Trajectory& estimate, const Trajectory& truth) {
  const ValidPart valid_estimate(estimate), valid_truth(truth);
  const Trajectory &poses = valid_estimate.poses(), &true_poses = valid_truth.poses();
  if (poses.size() < 2 || true_poses.size() < 2) return std::nullopt;
  const Duration longest = std::max(poses.back().stamp - poses.front().stamp,
                                    true_poses.back().stamp - true_poses.front().stamp);
  const Duration grid = std::max<Duration>(kGrid, longest / kMostSpeeds);
  const std::vector<double> a = speeds_of(poses, grid), b = speeds_of(true_poses, grid);
  const std::ptrdiff_t shorter = std::min(std::ssize(a), std::ssize(b));
  const std::ptrdiff_t least = std::max<std::ptrdiff_t>(kOverlap / grid, shorter / 2);
  const std::ptrdiff_t first = least - std::ssize(a), last = std::ssize(b) - least;
  if (least > shorter || last - first < 2) return std::nullopt;
  std::vector<double> by_lag;
  for (std::ptrdiff_t lag = first; lag <= last; ++lag) by_lag.push_back(correlation_at(a, b, lag));
  const auto peak = std::ranges::max_element(by_lag) - by_lag.begin();
  const double best = by_lag[static_cast<std::size_t>(peak)];
  if (peak == 0 || peak + 1 == std::ssize(by_lag)) return std::nullopt;
  for (std::ptrdiff_t i = 0; i < std::ssize(by_lag); ++i) {
    const bool beside = std::abs(i - peak) * grid <= std::max(kBeside, 2 * grid);
    if (!beside && by_lag[static_cast<std::size_t>(i)] > best - kLeastLead) return std::nullopt;
  }
  const auto at = static_cast<std::size_t>(peak);
  const double lag =
      static_cast<double>(first + peak) + top_of(by_lag[at - 1], best, by_lag[at + 1]);
  const Duration starts = true_poses.front().stamp - poses.front().stamp;
  const MotionOffset found =
      refined(poses, true_poses, to_seconds(starts) + lag * to_seconds(grid), to_seconds(grid));
  return found.correlation >= kLeastCorrelation ? std::optional(found) : std::nullopt;
}

std::optional<std::string> clock_offset_hint(const Trajectory& estimate, const Trajectory& truth) {
  const auto found = motion_offset(estimate, truth);
  if (!found || std::abs(found->seconds) < kLeastOffset) return std::nullopt;
  const ValidPart valid_estimate(estimate), valid_truth(truth);
  const Trajectory &poses = valid_estimate.poses(), &true_poses = valid_truth.poses();
  const Time first = poses.front().stamp;
  const Duration shift = from_seconds(found->seconds);
  const Duration common = std::min(poses.back().stamp + shift, true_poses.back().stamp) -
                          std::max(first + shift, true_poses.front().stamp);
  const Duration shorter =
      std::min(poses.back().stamp - first, true_poses.back().stamp - true_poses.front().stamp);
  if (to_seconds(common) < kCommon * to_seconds(shorter)) return std::nullopt;
  const double as_given = correlation_of(speeds_of(poses, kGrid), first, true_poses, 0.0);
  if (1.0 - found->correlation > kExplained * (1.0 - as_given)) return std::nullopt;
  return fmt::format(
      "likely a clock offset: with --time-offset {:.2f} it stands and walks when the truth does "
      "(their speeds correlate by {:.3f}, as given by {:.3f}); all scores compare other instants",
      found->seconds, found->correlation, as_given);
}

}  // namespace aims
