// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <boost/container/flat_map.hpp>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/config.hpp"
#include "core/measurements.hpp"
#include "estimator/filter/imu_history.hpp"
#include "estimator/filter/input_monitor.hpp"
#include "estimator/filter/stamp_jumps.hpp"

namespace aims {

/// Bound on measurements held back.
inline constexpr std::size_t kMaxHeld = 5000;

/// Order and completeness of the measurements.
struct QueueConfig {
  double lag = 0.05;       ///< measurements wait this long for earlier ones [s]
  double max_ahead = 5.0;  ///< a stamp further ahead of its arrival is rejected [s]
};

void describe(Fields& fields, QueueConfig& config);

/// A measurement that corrects the predicted state.
using Correction = std::variant<LegOdometrySample, LidarScanPtr>;

/// Sorts measurements by stamp within a fixed lag. Late, duplicate, non-finite and out-of-range
/// measurements and those whose stamps jump are dropped and counted, e.g. "leg.late".
class MeasurementQueue {
 public:
  /// `imu_rate_hz`: nominal sample rate [Hz]. Leg samples faster than `max_leg_speed` [m/s] are out
  /// of range.
  MeasurementQueue(const QueueConfig& config, const ImuPropagationConfig& imu, double imu_rate_hz,
                   double max_leg_speed);

  void push(const Delivery& delivery);

  /// The next correction in order of stamp, once the lag has passed and the IMU covers it or
  /// 0.3 s have passed.
  std::optional<Correction> pop();

  /// The stream has ended: everything held becomes ready.
  void close() { closed_ = true; }

  ImuHistory& imu() { return imu_; }
  const ImuHistory& imu() const { return imu_; }
  const std::map<std::string, int>& counts() const { return counts_; }
  /// Grows whenever a count does.
  int counted() const { return counted_; }
  const InputMonitor& inputs() const { return inputs_; }
  /// Latest arrival; empty before the first.
  std::optional<Time> now() const { return now_; }

 private:
  /// Stamp, then kind (leg before LiDAR), so that equal stamps have one order.
  using Key = std::pair<Time, int>;

  void accept(const ImuSample& sample);
  void accept(const LegOdometrySample& sample);
  void accept(const LidarScanPtr& scan);
  void hold(const Key& key, Sensor sensor, Correction correction);
  bool ready(Time stamp) const;
  bool plausible_stamp(Time stamp, Sensor sensor);
  void reject(Sensor sensor, const char* reason);
  void count(Sensor sensor, const char* what, int times = 1);

  QueueConfig config_;
  double max_leg_speed_;
  ImuHistory imu_;
  boost::container::flat_map<Key, Correction> held_;  ///< few: the lag is short
  std::optional<Key> last_popped_;
  std::optional<Time> now_;  ///< latest arrival
  bool closed_ = false;
  InputMonitor inputs_;
  std::array<StampJumps, kSensorCount> stamp_jumps_ = {StampJumps(true), StampJumps(false),
                                                       StampJumps(false)};
  std::vector<Delivery> good_;  ///< of the present delivery
  std::map<std::string, int> counts_;
  int counted_ = 0;
};

}  // namespace aims
