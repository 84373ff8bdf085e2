// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/aims/robot_prior.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace aims {
namespace {

constexpr const char* kSource = "docs/estimators.md#calibration-that-a-robot-keeps";

}  // namespace

void describe(Fields& f, RobotPriorConfig& c) {
  f.flag("enabled", c.enabled,
         {"", any(), "start from the calibration of this robot (`--calibration FILE`)", kSource});
  f.text("file", c.file, {"", any(), "the file that it was read from", kSource});
  const auto numbers = [&](std::string_view name, std::vector<double>& value,
                           const std::string& unit, const std::string& what) {
    f.numbers(name, value,
              {unit, within(kLargestPrior),
               what + ": values, then rows of their covariance from the "
                      "diagonal on",
               kSource});
  };
  numbers("legs_by_feet", c.legs_by_feet, "-, m/s", "scale and bias of legs measured by feet");
  numbers("legs_as_reported", c.legs_as_reported, "-, m/s", "scale and bias of reported velocity");
  numbers("joint_compliance", c.joint_compliance, "rad/m", "compliance of the joints");
  numbers("lidar_mount", c.lidar_mount, "rad", "rotation of the LiDAR's mount against the rig");
  numbers("imu_delay", c.imu_delay, "s", "delay of the IMU's stamps");
  numbers("gyro_bias", c.gyro_bias, "rad/s", "bias of the gyro");
  numbers("accelerometer_bias", c.accelerometer_bias, "m/s^2", "bias of the accelerometer");
  const bool nothing = std::ranges::all_of(
      kPriorQuantities, [&](const PriorQuantity& each) { return (c.*each.numbers).empty(); });
  f.idle_if(nothing, "no quantity is known", {"enabled"});
}

Result<void> check(const RobotPriorConfig& config) {
  if (!config.enabled) return {};
  for (const PriorQuantity& each : kPriorQuantities) {
    const std::vector<double>& numbers = config.*each.numbers;
    if (const std::string what = implausible(each.name, numbers); !what.empty()) {
      return failure(fmt::format("prior.{}: {}", each.name, what));
    }
    if (numbers.empty() || gaussian_of(numbers, each.size)) continue;
    return failure(
        fmt::format("prior.{}: expected {} values and the upper triangle of their "
                    "positive definite covariance, {} numbers, got {} numbers",
                    each.name, each.size, count_of_numbers(each.size), numbers.size()));
  }
  return {};
}

std::string implausible(std::string_view name, std::span<const double> values) {
  if (name != "legs_by_feet") return {};
  for (std::size_t axis = 0; axis < std::min<std::size_t>(3, values.size()); ++axis) {
    if (std::abs(values[axis]) <= kMostLegScale) continue;
    return fmt::format(
        "scale {} of {:.3g}: expected at most {} of either sign; beyond it the lengths of the legs "
        "(leg_geometry) are wrong",
        "xyz"[axis], values[axis], kMostLegScale);
  }
  return {};
}

std::optional<Gaussian> known(const RobotPriorConfig& config, std::string_view name) {
  const auto* quantity = std::ranges::find(kPriorQuantities, name, &PriorQuantity::name);
  if (!config.enabled || quantity == kPriorQuantities.end()) return std::nullopt;
  return gaussian_of(config.*quantity->numbers, quantity->size);
}

Belief with_entries(Belief belief, int offset, const Gaussian& values) {
  const auto size = values.mean.size();
  ErrorVector change = ErrorVector::Zero();
  change.segment(offset, size) =
      values.mean - boxminus(belief.state, NominalState()).segment(offset, size);
  belief.state = boxplus(belief.state, change);
  belief.covariance.middleRows(offset, size).setZero();
  belief.covariance.middleCols(offset, size).setZero();
  belief.covariance.block(offset, offset, size, size) = values.covariance;
  return belief;
}

Belief with_measured(const Belief& belief, ErrorState::Block at, const Gaussian& values) {
  LinearMeasurement measurement;
  measurement.residual = boxminus(belief.state, NominalState()).segment<3>(at.offset) - values.mean;
  columns(measurement.jacobian, at).setIdentity();
  measurement.noise = values.covariance;
  return fuse(belief, measurement);
}

}  // namespace aims
