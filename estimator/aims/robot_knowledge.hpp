// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "estimator/aims/config.hpp"
#include "estimator/aims/leg_comparison.hpp"
#include "estimator/filter/entry_information.hpp"
#include "estimator/interface/learned.hpp"
#include "estimator/legs/joint_compliance.hpp"

namespace aims {

/// With a leg scale known this well, a map along an unconstrained direction is not blurred [-].
inline constexpr double kKnownLegScale = 0.05;

/// Random walk of calibrated legs, relative to kLegScaleWalk: 0.4 % over 200 s.
inline constexpr double kWalkOfKnownLegs = 0.3;

/// What is known of the robot before a run, what the scans of the run say about it, and whether
/// they agree. A contradicted quantity is opened again to what an unknown robot has.
class RobotKnowledge {
 public:
  RobotKnowledge(const EskfConfig& config, double imu_rate_hz);

  /// The first belief with what is known of mount, delay and biases.
  Belief at_start(Belief belief);
  /// The belief with the known calibration of legs, by feet or as reported; for the first packet.
  Belief at_first_legs(Belief belief, bool by_feet);
  bool legs_are_known() const { return legs_known_; }

  /// Adds what a scan, `dt` [s] after the last one, made of the belief; the belief, with the
  /// quantities opened that it contradicts.
  Belief after_scan(const Belief& before, Belief after, double dt);
  /// Whether legs are known and what their packets say is compared with that.
  bool judges_legs() const { return quantities_[0].known.has_value(); }
  /// Adds what a leg packet made of the belief, where it corrects the leg states and is judged.
  void after_legs(const Belief& before, const Belief& after) { legs().data.add(before, after); }
  /// Adds the states after a scan by legs alone along the way and by scans, where they are
  /// compared (`cross_validation.measure_legs`), and whether scans constrain the way.
  void compare_legs(const NominalState& by_legs, const NominalState& by_scans, double dt,
                    bool constrained) {
    comparison_.add(by_legs, by_scans, dt, constrained);
  }
  /// Random walk of the leg states against that of an unknown robot: what is calibrated hardly
  /// changes on one way.
  double walk_of_legs() const { return legs_known_ ? kWalkOfKnownLegs : 1.0; }

  /// The names of quantities that became contradicted since the last call.
  std::vector<std::string> take_contradictions() { return std::exchange(contradicted_, {}); }

  /// Of the legs only where they are compared with scans.
  std::vector<LearnedQuantity> learned(const Belief& belief,
                                       const JointCompliance& compliance) const;

 private:
  /// Consecutive entries of the state that are constant but for a slow walk.
  struct Quantity {
    std::string name;
    int offset;
    std::vector<std::string> entries;
    Eigen::VectorXd prior;  ///< of an unknown robot
    Eigen::VectorXd sigma;  ///< likewise
    Eigen::VectorXd walk;   ///< per root of a second
    EntryInformation data;
    bool estimated = true;
    std::optional<Gaussian> known = std::nullopt;
    bool varies_by_run = false;
  };
  Quantity& legs() { return quantities_[0]; }
  Belief opened(Belief belief, Quantity& quantity);

  RobotPriorConfig prior_;
  LegStatesConfig leg_states_;
  std::vector<Quantity> quantities_;  ///< legs, mount, delay
  bool compared_ = false;             ///< legs with scans
  LegComparison comparison_;
  double duration_ = 0.0;  ///< of the data [s]
  bool by_feet_ = false;
  bool legs_known_ = false;
  std::vector<std::string> contradicted_;
};

}  // namespace aims
