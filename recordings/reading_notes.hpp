// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace aims {

/// What an assumption is about: estimators without that sensor are not concerned.
enum class WarnedSensor { kAny, kLidar, kLegs };

/// What a warning says, where something else depends on it.
enum class WarningKind {
  kOther,
  kMountAssumed,     ///< to be identity
  kClocks,           ///< differ
  kPointTimes,       ///< cannot serve
  kMissingMessages,  ///< were not recorded
  kRepeatedClouds,
  kDoubledTopic,     ///< had several publishers
  kJointRates,       ///< contradict the angles
  kDeadLegSensor,    ///< angles that stand still, a foot that never stands
  kFeetAgainstGyro,  ///< feet turn otherwise than the gyro says
};

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

/// Why stamps of a topic do not serve as they are.
enum class StampFault {
  kOtherClock,  ///< than the other topics have
  kUnusable,    ///< all the same, or zero: record times serve
};

/// What reading a recording assumes: conversions as notes, the rest as warnings.
struct ReadingNotes {
  std::vector<std::string> notes;
  std::vector<ReadingWarning> warnings;
  std::map<std::string, StampFault> stamp_faults;  ///< by topic; each is in notes or warnings too

  void push_back(std::string note) { notes.push_back(std::move(note)); }
  void warn(std::string reason, std::string text, WarnedSensor sensor = WarnedSensor::kAny,
            WarningKind kind = WarningKind::kOther) {
    warnings.push_back({std::move(reason), std::move(text), sensor, kind});
  }
  void warn(WarningKind kind, std::string reason, std::string text) {
    warn(std::move(reason), std::move(text), WarnedSensor::kAny, kind);
  }
};

}  // namespace aims
