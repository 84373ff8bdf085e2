// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/filter/queued_estimator.hpp"

#include <utility>
#include <variant>

namespace aims {

QueuedEstimator::QueuedEstimator(const QueueConfig& queue, const SensorRig& rig,
                                 std::vector<SeriesInfo> series, double max_leg_speed,
                                 const ImuPropagationConfig& imu)
    : rig_(rig), queue_(queue, imu, rig.imu_rate_hz, max_leg_speed) {
  result_.diagnostics.series = std::move(series);
}

void QueuedEstimator::consume(const Delivery& delivery) {
  queue_.push(delivery);
  process_ready();
}

void QueuedEstimator::finish() {
  queue_.close();
  process_ready();
}

void QueuedEstimator::process_ready() {
  if (start()) {
    while (const std::optional<Correction> next = queue_.pop()) {
      if (const auto* scan = std::get_if<LidarScanPtr>(&*next)) {
        process_scan(*scan);
      } else {
        process_legs(std::get<LegOdometrySample>(*next));
      }
    }
    end_delivery();
  }
  if (queue_.counted() == counted_) return;
  counted_ = queue_.counted();
  for (const auto& [name, count] : queue_.counts()) result_.counts[name] = count;
}

}  // namespace aims
