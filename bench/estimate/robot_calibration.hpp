// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <vector>

#include "estimator/interface/learned.hpp"
#include "estimator/robot_calibration.hpp"

namespace aims {

/// What one recording or sequence says about its robot.
struct CalibrationRun {
  std::string name;
  CalibratedSensors sensors;
  std::vector<LearnedQuantity> learned;
};

/// Runs that are needed to know how a quantity varies from run to run.
inline constexpr int kRunsOfVarying = 3;

/// The runs of one robot together, at least one. A quantity that is constant is their mean by
/// information, with the prior; where they disagree beyond their covariances (chi-square, 99 %) the
/// covariance is inflated by what they exceed them. One that varies by run has the spread of the
/// runs as covariance, and is used from three runs on.
RobotCalibration combined(std::span<const CalibrationRun> runs, const std::string& estimator);

/// Error when the body of a run is not that of the first: legs or mount.
Result<void> check_one_robot(std::span<const CalibrationRun> runs);

/// Warnings: what was calibrated from differs among the runs, recordings that disagree.
std::vector<std::string> warnings_of(const RobotCalibration& calibration,
                                     std::span<const CalibrationRun> runs);

/// Whether a YAML file is a recording: the mapping of a table of comma-separated values.
bool is_recorded_table(const std::filesystem::path& file);

}  // namespace aims
