// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <vector>

#include "estimator/filter/measurement_queue.hpp"
#include "estimator/interface/estimator.hpp"
#include "estimator/interface/estimator_config.hpp"

namespace aims {

/// An estimator that gets scans and leg samples in order of stamp, each when the IMU covers it.
class QueuedEstimator : public Estimator {
 public:
  void consume(const Delivery& delivery) override;
  void finish() override;
  const EstimatorResult& result() const override { return result_; }

 protected:
  /// `series`: reported of each scan. Leg samples faster than `max_leg_speed` [m/s] are dropped.
  QueuedEstimator(const QueueConfig& queue, const SensorRig& rig, std::vector<SeriesInfo> series,
                  double max_leg_speed = std::numeric_limits<double>::infinity(),
                  const ImuPropagationConfig& imu = {});

  /// Whether scans and leg samples are wanted; until then they wait.
  virtual bool start() { return true; }
  virtual void process_scan(const LidarScanPtr& scan) = 0;
  virtual void process_legs(const LegOdometrySample&) {}
  /// After the scans and leg samples that a delivery made ready.
  virtual void end_delivery() {}

  SensorRig rig_;
  MeasurementQueue queue_;
  EstimatorResult result_;

 private:
  void process_ready();

  int counted_ = 0;  ///< events of the queue when its counts were last copied
};

}  // namespace aims
