// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scoring/timed_estimator.hpp"

#include <algorithm>
#include <utility>

#include "core/stopwatch.hpp"

namespace aims {
TimedEstimator::TimedEstimator(std::string name, std::unique_ptr<Estimator> estimator)
    : name_(std::move(name)), estimator_(std::move(estimator)) {}

void TimedEstimator::consume(std::span<const Delivery> deliveries) {
  for (const Delivery& delivery : deliveries) {
    timed([&] { estimator_->consume(delivery); });
  }
}

void TimedEstimator::finish() {
  timed([&] { estimator_->finish(); });
}

EstimatorRows TimedEstimator::rows() const {
  const EstimatorResult& result = estimator_->result();
  const auto after = [](const auto& all, std::size_t passed) {
    return std::span(all).subspan(std::min(passed, all.size()));
  };
  return {.poses = after(result.trajectory, poses_passed_),
          .series = result.diagnostics.series,
          .scans = after(result.diagnostics.scans, scans_passed_),
          .wall_ms = after(scan_times_.wall_ms, scans_forgotten_ + scans_passed_),
          .health = after(result.health, health_passed_)};
}

void TimedEstimator::pass() {
  const EstimatorResult& result = estimator_->result();
  poses_passed_ = result.trajectory.size();
  scans_passed_ = result.diagnostics.scans.size();
  health_passed_ = result.health.size();
}

void TimedEstimator::forget() {
  pass();
  estimator_->forget_rows();
  poses_forgotten_ += poses_passed_;
  scans_forgotten_ += scans_passed_;
  pass();
  poses_forgotten_ -= poses_passed_;
  scans_forgotten_ -= scans_passed_;
}

/// Scans done so far; an estimator that looks at none is measured by its poses.
std::size_t TimedEstimator::scans_done() const {
  const EstimatorResult& result = estimator_->result();
  const std::size_t scans = scans_forgotten_ + result.diagnostics.scans.size();
  return scans == 0 ? poses_forgotten_ + result.trajectory.size() : scans;
}

template <class Work>
void TimedEstimator::timed(const Work& work) {
  const EstimatorResult& result = estimator_->result();
  const std::size_t scans_before = scans_done();
  const double external_before = result.external_cpu_s;
  const Stopwatch wall;
  const ThreadStopwatch cpu;
  work();
  cpu_since_scan_ += cpu.seconds() + result.external_cpu_s - external_before;
  const double seconds = wall.seconds();
  total_seconds_ += seconds;
  wall_since_scan_ += seconds;
  const std::size_t scans = scans_done();
  if (scans <= scans_before) return;
  const auto done = static_cast<double>(scans - scans_before);
  scan_times_.wall_ms.resize(scans, 1e3 * wall_since_scan_ / done);
  scan_times_.cpu_ms.resize(scans, 1e3 * cpu_since_scan_ / done);
  wall_since_scan_ = cpu_since_scan_ = 0.0;
}

void add_rows(const EstimatorRows& rows, EstimatorTotals& totals) {
  for (const StampedPose& each : rows.poses) {
    if (totals.poses == 0) {
      totals.first_pose = each.pose;
    } else {
      totals.path_m += (each.pose.translation - totals.last_pose.translation).norm();
    }
    totals.last_pose = each.pose;
    ++totals.poses;
  }
  totals.scans += rows.scans.size();
  for (const HealthRow& each : rows.health) add_health(each, totals.health);
}

}  // namespace aims
