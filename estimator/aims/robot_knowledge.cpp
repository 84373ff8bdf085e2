// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/aims/robot_knowledge.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "estimator/legs/feet.hpp"

namespace aims {
namespace {

using E = ErrorState;

const std::vector<std::string> kLegEntries = {"scale x [-]",  "scale y [-]",  "scale z [-]",
                                              "bias x [m/s]", "bias y [m/s]", "bias z [m/s]"};

/// Deviation of the delay of joint angles, which nothing measures [s]
/// (docs/decisions.md#each-foot-is-a-measurement).
constexpr double kJointDelaySigma = 4e-3;
/// Deviation between the scale that scans show and that of legs left to themselves [-].
constexpr double kScaleOfPlaces = 0.015;
/// Deviation of the gyro bias of a robot that did not stand (StaticInitializationConfig) [rad/s].
constexpr double kGyroBiasSigma = 0.01;

std::vector<std::string> axes(const std::string& unit) {
  return {"x [" + unit + "]", "y [" + unit + "]", "z [" + unit + "]"};
}

Eigen::VectorXd of_legs(double scale, double bias) {
  Eigen::VectorXd values(E::kLegSize);
  values << Eigen::Vector3d::Constant(scale), Eigen::Vector3d::Constant(bias);
  return values;
}

Eigen::VectorXd one(double value) { return Eigen::VectorXd::Constant(1, value); }
Eigen::VectorXd three(double value) { return Eigen::VectorXd::Constant(3, value); }
Eigen::MatrixXd square(double value) { return Eigen::MatrixXd::Constant(1, 1, value); }

/// Of a bias: what the whole belief says at the end.
LearnedQuantity bias_of(const Belief& belief, E::Block at, std::string name,
                        const std::string& unit, double sigma) {
  const ErrorMatrix P = stated_covariance(belief);
  const Eigen::Matrix3d information = block(P, at, at).inverse();
  const Eigen::Vector3d value = entries_of(belief.state, at.offset, 3);
  return {std::move(name), axes(unit),   information, information * value,
          three(0.0),      three(sigma), true};
}

}  // namespace

RobotKnowledge::RobotKnowledge(const EskfConfig& config, double imu_rate_hz)
    : prior_(config.prior), leg_states_(config.leg_states), compared_(measures_legs(config)) {
  leg_states_.enabled = leg_states_.enabled && config.legs.enabled;
  const CalibrationConfig& unknown = config.calibration;
  const CalibrationConfig estimated = estimated_calibration(config);
  const double quarter = 0.25 / imu_rate_hz;
  quantities_.push_back({"legs_as_reported", E::kLegScale.offset, kLegEntries, of_legs(0.0, 0.0),
                         of_legs(leg_states_.scale_sigma, kLegBiasSigma),
                         of_legs(kLegScaleWalk, kLegBiasWalk),
                         EntryInformation(E::kLegScale.offset, E::kLegSize),
                         leg_states_.enabled && config.lidar.enabled});
  quantities_.push_back(
      {"lidar_mount", E::kMount.offset, axes("rad"), three(0.0), three(unknown.mount_sigma),
       three(kMountWalk), EntryInformation(E::kMount.offset, 3),
       estimated.enabled && estimated.mount_sigma > 0.0, known(prior_, "lidar_mount")});
  quantities_.push_back({"imu_delay",
                         E::kDelay,
                         {"delay [s]"},
                         one(quarter),
                         one(std::hypot(unknown.delay_sigma, quarter)),
                         one(kDelayWalk),
                         EntryInformation(E::kDelay, 1),
                         estimated.enabled,
                         known(prior_, "imu_delay"),
                         true});
}

Belief RobotKnowledge::at_start(Belief belief) {
  for (Quantity& each : quantities_) {
    if (!each.known) continue;
    const Eigen::MatrixXd fixed =
        belief.covariance.block(each.offset, each.offset, each.sigma.size(), each.sigma.size());
    belief = with_entries(belief, each.offset,
                          {each.known->mean, each.estimated ? each.known->covariance : fixed});
  }
  if (const auto bias = known(prior_, "gyro_bias")) {
    belief = with_measured(belief, E::kGyroBias, *bias);
  }
  if (const auto bias = known(prior_, "accelerometer_bias")) {
    belief = with_measured(belief, E::kAccelerometerBias, *bias);
  }
  return belief;
}

Belief RobotKnowledge::at_first_legs(Belief belief, bool by_feet) {
  by_feet_ = by_feet;
  if (!leg_states_.enabled) return belief;
  if (by_feet) {
    legs().name = "legs_by_feet";
    legs().sigma.head<3>().setConstant(std::min(kFeetScaleSigma, leg_states_.scale_sigma));
    block(belief.covariance, E::kLegScale, E::kLegScale) =
        legs().sigma.head<3>().cwiseAbs2().asDiagonal();
  }
  legs().known = known(prior_, legs().name);
  legs_known_ = legs().known && legs().known->covariance(0, 0) < kKnownLegScale * kKnownLegScale;
  return legs().known ? with_entries(belief, E::kLegScale.offset, *legs().known) : belief;
}

Belief RobotKnowledge::opened(Belief belief, Quantity& quantity) {
  const auto size = quantity.sigma.size();
  belief.covariance.block(quantity.offset, quantity.offset, size, size) +=
      quantity.sigma.cwiseAbs2().asDiagonal().toDenseMatrix();
  quantity.known.reset();
  contradicted_.push_back(quantity.name);
  return belief;
}

Belief RobotKnowledge::after_scan(const Belief& before, Belief after, double dt) {
  duration_ += dt;
  for (Quantity& each : quantities_) {
    if (!each.estimated) continue;
    each.data.add(before, after);
    if (!each.known) continue;
    EntryMatrix covariance = each.known->covariance;
    covariance.diagonal() += duration_ * each.walk.cwiseAbs2();
    if (each.offset == E::kLegScale.offset) {
      covariance.diagonal().head<3>().array() += kScaleOfPlaces * kScaleOfPlaces;
    }
    const double limit = kChiSquare9999[static_cast<std::size_t>(each.sigma.size() - 1)];
    if (disagreement(each.data, each.known->mean, covariance) > limit) {
      after = opened(after, each);
    }
  }
  return after;
}

std::vector<LearnedQuantity> RobotKnowledge::learned(const Belief& belief,
                                                     const JointCompliance& compliance) const {
  std::vector<LearnedQuantity> all;
  for (const Quantity& each : quantities_) {
    const bool legs = each.offset == E::kLegScale.offset;
    if (legs && !compared_) continue;
    const Eigen::MatrixXd data = each.data.matrix();
    const Eigen::VectorXd vector = each.data.vector();
    all.push_back({each.name, each.entries, legs ? comparison_.information() : data,
                   legs ? comparison_.vector(belief.state) : vector, each.prior, each.sigma,
                   each.varies_by_run});
  }
  if (by_feet_) {
    all.push_back({"joint_compliance",
                   {"compliance [rad/m]"},
                   square(compliance.information()),
                   one(compliance.information_vector()),
                   one(JointCompliance::kPrior),
                   one(JointCompliance::kSigma)});
    all.push_back({"joint_delay",
                   {"delay [s]"},
                   square(0.0),
                   one(0.0),
                   one(kJointDelay),
                   one(kJointDelaySigma)});
  }
  all.push_back(bias_of(belief, E::kGyroBias, "gyro_bias", "rad/s", kGyroBiasSigma));
  all.push_back(bias_of(belief, E::kAccelerometerBias, "accelerometer_bias", "m/s^2", 0.25));
  return all;
}

}  // namespace aims
