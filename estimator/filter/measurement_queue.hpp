// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "core/measurements.hpp"
#include "estimator/aims/config.hpp"
#include "estimator/filter/imu_history.hpp"

namespace aims {

/// A measurement that corrects the predicted state.
using Correction = std::variant<LegOdometrySample, LidarScanPtr>;

/// Puts what arrives into order of stamp within a fixed lag. Late, duplicate, non-finite and
/// out-of-range measurements are dropped and counted, e.g. "leg.late".
class MeasurementQueue {
 public:
  explicit MeasurementQueue(const EstimatorConfig& config);

  void push(const Delivery& delivery);

  /// The next correction in order of stamp, once the lag has passed and the IMU covers it (or has
  /// been waited for in vain).
  std::optional<Correction> pop();

  /// Nothing more will come: what is held is ready.
  void close() { closed_ = true; }

  ImuHistory& imu() { return imu_; }
  const std::map<std::string, int>& counts() const { return counts_; }

 private:
  /// Stamp, then kind (leg before LiDAR), so that equal stamps have one order.
  using Key = std::pair<Time, int>;

  void accept(const ImuSample& sample);
  void accept(const LegOdometrySample& sample);
  void accept(const LidarScanPtr& scan);
  void hold(const Key& key, const std::string& name, Correction correction);
  bool ready(Time stamp) const;
  bool plausible_stamp(Time stamp, const std::string& name);
  void count(const std::string& what) { ++counts_[what]; }

  EstimatorConfig config_;
  ImuHistory imu_;
  std::map<Key, Correction> held_;
  std::optional<Key> last_popped_;
  std::optional<Time> now_;  ///< latest arrival
  bool closed_ = false;
  std::map<std::string, int> counts_;
};

}  // namespace aims
