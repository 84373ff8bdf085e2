// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/robot_calibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/files/config_dump.hpp"
#include "core/files/yaml_config.hpp"
#include "estimator/aims/robot_prior.hpp"

namespace aims {
namespace {

constexpr double kLargest = 1e12;  ///< of what is only read
constexpr double kDegree = 57.295779513082320;

// Differences that are no rounding.
constexpr double kLengthDiffers = 1e-3;  ///< of links [m]
constexpr double kMountDiffers = 1e-2;   ///< [m]
constexpr double kAngleDiffers = 1.0;    ///< [deg]
constexpr double kRateDiffers = 0.2;     ///< relative

std::vector<double> all_numbers(const CalibratedQuantity& quantity) {
  std::vector<double> numbers = quantity.values;
  numbers.insert(numbers.end(), quantity.covariance.begin(), quantity.covariance.end());
  return numbers;
}

Result<void> check(const CalibratedQuantity& quantity) {
  if (!quantity.used) return {};
  const auto* known = std::ranges::find(kPriorQuantities, quantity.name, &PriorQuantity::name);
  if (known == kPriorQuantities.end()) {
    return failure(
        fmt::format("name '{}': expected a quantity that estimators start from, e.g. "
                    "{}, or used: false",
                    quantity.name, kPriorQuantities.front().name));
  }
  if (const std::string what = implausible(quantity.name, quantity.values); !what.empty()) {
    return failure(fmt::format("{}: {}, or used: false", quantity.name, what));
  }
  if (gaussian_of(all_numbers(quantity), known->size)) return {};
  return failure(
      fmt::format("{}: expected {} values and the {} numbers of the upper triangle of "
                  "their positive definite covariance, got {} and {}",
                  quantity.name, known->size, count_of_numbers(known->size) - known->size,
                  quantity.values.size(), quantity.covariance.size()));
}

bool differ(double a, double b, double relative) {
  return a > 0.0 && b > 0.0 && std::abs(a - b) > relative * std::max(a, b);
}

double largest_difference(const LegGeometry& a, const LegGeometry& b) {
  return std::max({std::abs(a.hip_x - b.hip_x), std::abs(a.hip_y - b.hip_y),
                   std::abs(a.abduction - b.abduction), std::abs(a.thigh - b.thigh),
                   std::abs(a.calf - b.calf), std::abs(a.foot_radius - b.foot_radius)});
}

}  // namespace

void describe(Fields& f, CalibratedQuantity& c) {
  const auto numbers = [&](std::string_view name, std::vector<double>& value,
                           const std::string& meaning) {
    f.numbers(name, value, {"", within(kLargestPrior), meaning});
  };
  f.text("name", c.name, {.meaning = "quantity"});
  f.texts("entries", c.entries, {.meaning = "its entries, with unit"});
  numbers("values", c.values, "one per entry");
  numbers("covariance", c.covariance, "upper triangle, row by row");
  numbers("sigma", c.sigma, "standard deviations by the covariance");
  numbers("prior_sigma", c.prior_sigma, "those of a robot without calibration");
  f.texts("verdict", c.verdict, {.meaning = "observable: sigma is at most half of prior_sigma"});
  f.flag("used", c.used, {.meaning = "estimators start from it"});
  f.text("note", c.note, {});
  f.number("chi_square", c.chi_square,
           {"-", up_to(kLargest), "of the recordings about their weighted mean"});
  f.integer("degrees_of_freedom", c.degrees_of_freedom, {"-", up_to(1e6), "of chi_square"});
  f.number("inflation", c.inflation,
           {"-", up_to(kLargest), "of the covariance, where recordings disagree"});
}

void describe(Fields& f, CalibratedSensors& c) {
  f.group("legs", c.legs);
  f.vector("lidar_translation", c.lidar_translation, {"m", within(1e3), "in the IMU's frame"});
  f.vector("lidar_rotation_deg", c.lidar_rotation_deg,
           {"deg", within(1e3), "rotation vector, in the IMU's frame"});
  f.number("imu_rate", c.imu_rate, {"Hz", up_to(1e5), "nominal"});
  f.number("leg_rate", c.leg_rate, {"Hz", up_to(1e5), "nominal"});
  f.texts("topics", c.topics, {.meaning = "of the recordings; none: simulated sequences"});
}

void describe(Fields& f, RobotCalibration& c) {
  f.text("schema", c.schema, {.meaning = "layout of this file"});
  f.text("estimator", c.estimator, {.meaning = "who estimated"});
  f.texts("recordings", c.recordings, {.meaning = "what it was estimated from"});
  f.group("sensors", c.sensors);
  f.list("quantities", c.quantities, "what stays with the robot");
}

Result<RobotCalibration> read_robot_calibration(const std::filesystem::path& file) {
  RobotCalibration calibration;
  calibration.schema.clear();
  if (auto ok = load_config(file, calibration); !ok) return tl::unexpected(ok.error());
  if (calibration.schema != kCalibrationSchema) {
    return failure(fmt::format("{}: schema: expected {}, as `aims calibrate` writes it, got '{}'",
                               file.string(), kCalibrationSchema, calibration.schema));
  }
  for (std::size_t i = 0; i < calibration.quantities.size(); ++i) {
    const auto ok = check(calibration.quantities[i]);
    if (!ok) {
      return failure(fmt::format("{}: quantities.{}: {}", file.string(), i, ok.error().message));
    }
  }
  return calibration;
}

std::string text_of(const RobotCalibration& calibration) {
  RobotCalibration copy = calibration;
  return dump_config(fields_of(copy));
}

std::vector<std::string> prior_settings(const RobotCalibration& calibration,
                                        const std::filesystem::path& file) {
  std::vector<std::string> settings = {"estimators.*.prior.enabled=true",
                                       "estimators.*.prior.file=" + file.string()};
  const auto used = std::ranges::count(calibration.quantities, true, &CalibratedQuantity::used);
  if (used == 0) return {};
  for (const CalibratedQuantity& each : calibration.quantities) {
    if (!each.used) continue;
    settings.push_back(
        fmt::format("estimators.*.prior.{}=[{}]", each.name, fmt::join(all_numbers(each), ", ")));
  }
  return settings;
}

std::string nothing_used(const RobotCalibration& calibration, const std::filesystem::path& file) {
  if (std::ranges::count(calibration.quantities, true, &CalibratedQuantity::used) > 0) return "";
  return fmt::format(
      "no quantity of the calibration {} is used: estimators start as they do without it",
      file.string());
}

CalibratedSensors sensors_of(const SensorRig& rig, std::vector<std::string> topics) {
  return {rig.leg_geometry,
          rig.T_body_lidar.translation,
          kDegree * so3_log(rig.T_body_lidar.rotation),
          rig.imu_rate_hz,
          rig.leg_rate_hz,
          std::move(topics)};
}

std::vector<std::string> body_misfits(const CalibratedSensors& calibrated,
                                      const CalibratedSensors& sensors) {
  std::vector<std::string> found;
  if (largest_difference(calibrated.legs, sensors.legs) > kLengthDiffers) {
    found.emplace_back("legs of other dimensions");
  }
  const bool moved =
      (calibrated.lidar_translation - sensors.lidar_translation).norm() > kMountDiffers;
  const bool turned =
      (calibrated.lidar_rotation_deg - sensors.lidar_rotation_deg).norm() > kAngleDiffers;
  if (sensors.has_lidar && (moved || turned)) found.emplace_back("another mount of the LiDAR");
  return found;
}

std::vector<std::string> misfits(const CalibratedSensors& calibrated,
                                 const CalibratedSensors& sensors) {
  std::vector<std::string> found = body_misfits(calibrated, sensors);
  if (differ(calibrated.imu_rate, sensors.imu_rate, kRateDiffers)) {
    found.push_back(fmt::format("an IMU of {:.0f} instead of {:.0f} Hz", sensors.imu_rate,
                                calibrated.imu_rate));
  }
  if (differ(calibrated.leg_rate, sensors.leg_rate, kRateDiffers)) {
    found.push_back(
        fmt::format("legs at {:.0f} instead of {:.0f} Hz", sensors.leg_rate, calibrated.leg_rate));
  }
  const bool all_known = std::ranges::all_of(sensors.topics, [&](const std::string& each) {
    return std::ranges::find(calibrated.topics, each) != calibrated.topics.end();
  });
  if (!calibrated.topics.empty() && !all_known) {
    found.push_back(fmt::format("topics {} instead of {}", fmt::join(sensors.topics, ", "),
                                fmt::join(calibrated.topics, ", ")));
  }
  return found;
}

}  // namespace aims
