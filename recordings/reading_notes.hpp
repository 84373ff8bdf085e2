// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace aims {

/// What an assumption is about: estimators without that sensor are not concerned.
enum class WarnedSensor { kAny, kLidar, kLegs };

/// What decides more than a sentence: clocks that differ, an extrinsic that nothing states.
enum class WarningKind { kOther, kClocks, kNoTransform };

/// An assumption that decides the result of an estimate, or a fault of the recording that spoils
/// it.
struct ReadingWarning {
  std::string reason;  ///< in a few words, for the health: "clocks of LiDAR and IMU differ"
  std::string text;    ///< one sentence with the key that changes it
  WarnedSensor sensor = WarnedSensor::kAny;
  WarningKind kind = WarningKind::kOther;

  /// Whether it concerns an estimator that uses these sensors.
  bool concerns(bool uses_lidar, bool uses_legs) const {
    if (sensor == WarnedSensor::kLidar) return uses_lidar;
    return sensor == WarnedSensor::kAny || uses_legs;
  }
};

/// What reading a recording assumes: conversions as notes, the rest as warnings.
struct ReadingNotes {
  std::vector<std::string> notes;
  std::vector<ReadingWarning> warnings;

  void push_back(std::string note) { notes.push_back(std::move(note)); }
  void warn(std::string reason, std::string text, WarnedSensor sensor = WarnedSensor::kAny,
            WarningKind kind = WarningKind::kOther) {
    warnings.push_back({std::move(reason), std::move(text), sensor, kind});
  }
};

}  // namespace aims
