// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "core/config.hpp"
#include "core/error.hpp"
#include "core/measurements.hpp"

namespace aims {

/// Version of the layout of a calibration file (docs/result-files.md).
inline constexpr const char* kCalibrationSchema = "aims.robot_calibration/1";

/// A quantity of a robot, as recordings have shown it.
struct CalibratedQuantity {
  std::string name;                  ///< as of LearnedQuantity
  std::vector<std::string> entries;  ///< names with unit
  std::vector<double> values;        ///< one per entry
  std::vector<double> covariance;    ///< upper triangle, row by row
  std::vector<double> sigma;         ///< deviations by the covariance, for readers
  std::vector<double> prior_sigma;   ///< of a robot without calibration
  std::vector<std::string> verdict;  ///< per entry: kObservable or kNotObservable
  bool used = false;                 ///< becomes a prior
  std::string note;                  ///< e.g. why it is not used
  double chi_square = 0.0;           ///< of the recordings about their mean; 0 for one
  int degrees_of_freedom = 0;        ///< of it
  double inflation = 1.0;            ///< of the covariance, since recordings disagree
};

inline constexpr const char* kObservable = "observable";
inline constexpr const char* kNotObservable = "not observable";

/// The reason in the health of an estimate that starts from the calibration of another robot.
inline constexpr const char* kOtherRobot = "calibration of another robot";

/// What a calibration holds for: another robot has other figures.
struct CalibratedSensors {
  LegGeometry legs;
  Eigen::Vector3d lidar_translation = Eigen::Vector3d::Zero();   ///< in the body frame [m]
  Eigen::Vector3d lidar_rotation_deg = Eigen::Vector3d::Zero();  ///< rotation vector [deg]
  double imu_rate = 0.0;                                         ///< [Hz]
  double leg_rate = 0.0;                                         ///< [Hz]
  std::vector<std::string> topics;                               ///< of a recording; else none
  bool has_lidar = true;                                         ///< else it has no mount
};

/// What stays with a robot, from recordings of it.
struct RobotCalibration {
  std::string schema = kCalibrationSchema;
  std::string estimator;                ///< spec of who estimated
  std::vector<std::string> recordings;  ///< that it was estimated from
  CalibratedSensors sensors;
  std::vector<CalibratedQuantity> quantities;
};

void describe(Fields& fields, CalibratedQuantity& quantity);
void describe(Fields& fields, CalibratedSensors& sensors);
void describe(Fields& fields, RobotCalibration& calibration);

/// Error for a file that is no calibration, with the line and what was expected.
Result<RobotCalibration> read_robot_calibration(const std::filesystem::path& file);

/// As YAML with comments.
std::string text_of(const RobotCalibration& calibration);

/// The settings that make the calibration the prior of every estimator that has one; none where no
/// quantity is used.
std::vector<std::string> prior_settings(const RobotCalibration& calibration,
                                        const std::filesystem::path& file);

/// What is to be said of the calibration of `file` when no quantity of it is used; else empty.
std::string nothing_used(const RobotCalibration& calibration, const std::filesystem::path& file);

CalibratedSensors sensors_of(const SensorRig& rig, std::vector<std::string> topics);

/// How the body and its mount differ, by which it is another robot for certain.
std::vector<std::string> body_misfits(const CalibratedSensors& calibrated,
                                      const CalibratedSensors& sensors);

/// How `sensors` differ from those that a calibration holds for, one clause each; empty: they fit.
std::vector<std::string> misfits(const CalibratedSensors& calibrated,
                                 const CalibratedSensors& sensors);

}  // namespace aims
