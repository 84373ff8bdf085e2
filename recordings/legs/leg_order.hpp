// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/leg_kinematics.hpp"
#include "core/measurements.hpp"
#include "recordings/legs/leg_evidence.hpp"
#include "recordings/legs/leg_messages.hpp"

namespace aims {

/// Which joint and which foot each entry of a recording's arrays is, where their names do not tell.
struct LegOrder {
  JointOrder joints{};
  std::array<int, kLegCount> feet = {0, 1, 2, 3};  ///< leg of each entry of the contacts
  std::string text;  ///< "FL hip 0, thigh 1, ...": what was decided, and how surely
};

/// Indices of the abductions, hips and knees, each in the order of the array.
using JointKinds = std::array<std::array<std::size_t, kLegCount>, 3>;

/// Finds the order from the motion: mean angles tell abduction, hip and knee of Unitree's
/// convention; of the orders of the legs that one is taken in which the feet in contact agree best
/// on the velocity of the base.
class LegOrderFinder {
 public:
  void add_imu(const Eigen::Vector3d& angular_velocity) { turning_ = angular_velocity; }
  /// Loads by entry, or by leg where the feet are named.
  void add_loads(const FootLoads& loads);
  /// Twelve angles; `rates` may be empty.
  void add_joints(Time stamp, const std::vector<double>& angles, const std::vector<double>& rates);

  bool full() const;

  /// `joints` and `feet`: where the names tell the order. Error where the data do not decide, and
  /// the orders in question differ in the velocity of the base.
  Result<LegOrder> find(const LegGeometry& geometry, const Eigen::Quaterniond& R_body_base,
                        const std::optional<JointOrder>& joints, bool feet_named) const;

 private:
  struct Row {
    Time stamp = 0;
    JointVector angles, rates;
    bool has_rates = false;
    Eigen::Vector3d turning;
    FootLoads loads{};
  };
  std::vector<Row> with_rates() const;
  std::vector<LegEvidence> evidence(const JointKinds& kinds, const LegGeometry& geometry,
                                    const Eigen::Quaterniond& R_body_base) const;
  static LegEvidence evidence_of(const Row& row, const JointKinds& kinds,
                                 const LegGeometry& geometry,
                                 const Eigen::Quaterniond& R_body_base);

  Eigen::Vector3d turning_ = Eigen::Vector3d::Zero();  ///< in the IMU's axes [rad/s]
  std::optional<FootLoads> loads_;
  std::vector<Row> rows_;
};

}  // namespace aims
