// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/measurements.hpp"

namespace aims {

/// A foot is in contact from a load of `begin` on, until its load falls below `end` <= `begin`.
struct ContactThreshold {
  double begin = 0.0;
  double end = 0.0;
  int sign = 0;  ///< of the load of a foot that stands; 0: either, as of torques
};

/// Detects contacts in a sequence of loads, in newtons or any other unit. Without a sign in the
/// threshold that of a load is ignored: the torque of a loaded knee has either one.
class ContactDetector {
 public:
  ContactDetector() = default;
  explicit ContactDetector(const std::array<ContactThreshold, kLegCount>& thresholds)
      : thresholds_(thresholds) {}

  std::array<bool, kLegCount> detect(const FootLoads& loads);

  /// Whether a load is as large as that of a foot in contact, and has the other sign.
  bool contradicts_sign(const FootLoads& loads) const;

 private:
  std::array<ContactThreshold, kLegCount> thresholds_{};
  std::array<bool, kLegCount> contact_{};
};

/// Threshold from loads of a foot without calibration. The logarithms of 1 + load are divided
/// into two classes of least variance within (Otsu 1979). The thresholds lie a tenth of the
/// distance of the means above and below their middle. Error, naming the foot, where the loads are
/// not of two classes: each needs a twentieth of the loads, and the means 3.7 times the spread
/// within (equally spread loads have 3.5 times, a bell-shaped distribution 2.7 times). The upper
/// mean must be 1.5 times the lower: a robot that shifts its weight while it stands, or whose loads
/// have few digits, has two classes too.
Result<ContactThreshold> learn_contact_threshold(const std::vector<FootLoads>& loads,
                                                 std::size_t leg);

/// The same of all feet.
Result<std::array<ContactThreshold, kLegCount>> learn_contact_thresholds(
    const std::vector<FootLoads>& loads);

}  // namespace aims
