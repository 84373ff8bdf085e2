// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>
#include <vector>

namespace aims {

/// How real the errors of the sensors are.
enum class SensorLevel {
  kIdeal,      ///< white noise, averaged samples, perfect calibration
  kDatasheet,  ///< what the parts' datasheets state
  kField,      ///< what recordings of real robots show
};

/// Part whose figures the IMU has.
enum class ImuGrade {
  kOfLevel,     ///< as the level of the sensors says
  kIdeal,       ///< white noise and a constant bias
  kMems,        ///< a consumer part
  kIndustrial,  ///< a calibrated module
};

/// A file of `models/sensors`, part of the program.
struct SensorPreset {
  std::string_view name;  ///< of the file, without its ending
  std::string_view text;  ///< YAML with keys of a scenario
};

/// The presets of a level and a grade, in the order in which they apply.
std::vector<SensorPreset> sensor_presets(SensorLevel level, ImuGrade grade);

}  // namespace aims
