// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "recordings/legs/leg_messages.hpp"
#include "recordings/reading_notes.hpp"

namespace aims {

/// Compares the rates of joints with what their angles change by, in another unit or with another
/// sign of which no estimate of the velocity is right.
class JointRateCheck {
 public:
  /// As recorded. Readings without rates tell nothing.
  void add(const JointReading& reading);

  /// What contradicts; nothing with too little motion.
  std::optional<ReadingWarning> warning() const;

 private:
  void begin(const JointReading& reading);
  void close(const JointReading& reading);

  std::optional<JointReading> first_, last_;  ///< of a window, and before this one
  std::array<double, kJointCount> turned_{};  ///< by the rates since the first [rad]
  std::vector<double> ratios_;                ///< of that to the change of the angle
};

}  // namespace aims
