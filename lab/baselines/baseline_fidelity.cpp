// SPDX-License-Identifier: BSD-3-Clause
#include "lab/baselines/baseline_fidelity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bench/estimate/bag_origin.hpp"
#include "bench/metrics/segments.hpp"
#include "core/files/atomic_file.hpp"
#include "core/files/tum.hpp"
#include "core/files/waypoint_times.hpp"

namespace aims {
namespace {

Result<std::vector<WaypointTime>> waypoint_times_of(const BaselineFidelityRequest& request) {
  if (request.waypoint_times.empty()) {
    auto origin = bag_origin(request.options.bag);
    if (!origin) return tl::unexpected(origin.error());
    return std::move(origin->waypoint_times);
  }
  return read_waypoint_times(request.waypoint_times);
}

/// The published poses as poses of the IMU, with the stamps of the recording.
Result<Trajectory> reference_of(const std::filesystem::path& file, ReferenceBody body,
                                const EstimateResult& recording) {
  auto trajectory = read_tum(file);
  if (!trajectory) return trajectory;
  if (trajectory->empty()) return failure(fmt::format("{}: no poses", file.string()));
  const Time start = recording.truth.front().stamp;
  const Duration offset = trajectory->front().stamp < start ? start : 0;
  const Pose T_lidar_body = recording.setup.rig.T_body_lidar.inverse();
  for (StampedPose& each : *trajectory) {
    each.stamp += offset;
    if (body == ReferenceBody::kLidar) each.pose = each.pose * T_lidar_body;
  }
  return trajectory;
}

/// The poses at the stamps of `reference`, where there are any.
Trajectory sampled(const Trajectory& trajectory, const Trajectory& reference) {
  Trajectory samples;
  for (const StampedPose& each : reference) {
    if (const auto pose = pose_at(trajectory, each.stamp)) samples.push_back({each.stamp, *pose});
  }
  return samples;
}

bool within(const std::optional<double>& native, const std::optional<double>& published,
            double least) {
  if (!native || !published) return native.has_value() == published.has_value();
  return std::abs(*native - *published) <= std::max(least, kScoreTolerance * *published);
}

std::optional<double> end_error(const Scores& scores) {
  return scores.m_end ? std::optional(scores.m_end->norm_m) : std::nullopt;
}

std::string number(const std::optional<double>& value) {
  return value ? fmt::format("{:.3f}", *value) : "-";
}

std::vector<std::string> row_of(const std::string& name, const Scores& scores, Time start) {
  std::string m_list;
  for (const SegmentDistance& each : scores.segments) {
    m_list += (m_list.empty() ? "" : " / ") + number(each.percent);
  }
  return {name,
          m_list.empty() ? "-" : m_list,
          number(end_error(scores)),
          number(scores.ate_m),
          number(scores.max_abs_z_error_m),
          scores.diverged_at
              ? fmt::format("diverged at {:.1f} s", to_seconds(*scores.diverged_at - start))
              : std::string(scores.success ? "yes" : name_of(scores.failure_reason))};
}

}  // namespace

bool BaselineComparison::agrees() const {
  if (published.success != native.success) return false;
  return !published.success ||
         (within(native.m_list_percent, published.m_list_percent, kMListTolerancePercent) &&
          within(end_error(native), end_error(published), kMEndTolerance));
}

std::optional<PositionDifference> position_difference(const Trajectory& other,
                                                      const Trajectory& reference) {
  std::optional<Pose> T_reference_other;
  PositionDifference difference;
  double sum = 0.0;
  int count = 0;
  for (const StampedPose& each : reference) {
    const auto pose = pose_at(other, each.stamp);
    if (!pose) continue;
    if (!T_reference_other) T_reference_other = each.pose * pose->inverse();
    const double distance = (*T_reference_other * pose->translation - each.pose.translation).norm();
    difference.max = std::max(difference.max, distance);
    sum += distance * distance;
    ++count;
  }
  if (count == 0) return std::nullopt;
  difference.rms = std::sqrt(sum / count);
  return difference;
}

Result<std::vector<BaselineComparison>> baseline_fidelity(const BaselineFidelityRequest& request,
                                                          const Observer& observer) {
  if (request.references.size() != request.config.run.size()) {
    return failure(fmt::format("--reference: expected one for each of {} estimators, found {}",
                               request.config.run.size(), request.references.size()));
  }
  const auto waypoint_times = waypoint_times_of(request);
  if (!waypoint_times) return tl::unexpected(waypoint_times.error());
  const auto recording = estimate(request.config, request.options, observer);
  if (!recording) return tl::unexpected(recording.error());
  if (!recording->failures.empty()) {  // those without poses are missing among the estimators
    const EstimatorFailure& first = recording->failures.front();
    return failure(fmt::format("{} failed: {}", first.name, first.message));
  }
  if (recording->truth.empty()) {
    return failure(fmt::format("{}: holds no truth to score with", request.options.bag.string()));
  }
  const ScoreConfig& scoring = request.config.scoring;
  std::vector<BaselineComparison> comparisons;
  for (std::size_t i = 0; i < request.references.size(); ++i) {
    const auto reference = reference_of(request.references[i], request.body, *recording);
    if (!reference) return tl::unexpected(reference.error());
    const EstimatorOutcome& native = recording->estimators[i];
    const auto difference = position_difference(native.result.trajectory, *reference);
    if (!difference) {
      return failure(fmt::format("{}: no stamps in common with {}", request.references[i].string(),
                                 native.name));
    }
    comparisons.push_back({native.name, request.references[i].filename().string(),
                           recording->truth.front().stamp,
                           score(*reference, recording->truth, *waypoint_times, scoring),
                           score(sampled(native.result.trajectory, *reference), recording->truth,
                                 *waypoint_times, scoring),
                           difference->rms, difference->max});
  }
  return comparisons;
}

TextTable baseline_fidelity_table(const std::vector<BaselineComparison>& comparisons) {
  TextTable table;
  table.header = {"trajectory", "M_list %", "M_end m", "ATE m",        "max |z| m",
                  "success",    "RMS m",    "max m",   "within limits"};
  for (const BaselineComparison& each : comparisons) {
    auto published = row_of(each.reference, each.published, each.start);
    published.insert(published.end(), {"", "", ""});
    table.rows.push_back(std::move(published));
    auto native = row_of(each.estimator, each.native, each.start);
    native.insert(native.end(), {number(each.rms_difference), number(each.max_difference),
                                 each.agrees() ? "yes" : "no"});
    table.rows.push_back(std::move(native));
  }
  return table;
}

Result<void> write_baseline_fidelity(const std::vector<BaselineComparison>& comparisons,
                                     const std::filesystem::path& folder) {
  const TextTable table = baseline_fidelity_table(comparisons);
  return write_file_atomically(
      folder / "baselines.md",
      "# Baselines against the published systems\n\n" + to_markdown(table));
}

}  // namespace aims
