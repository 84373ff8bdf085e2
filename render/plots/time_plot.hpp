// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "core/error.hpp"

namespace aims {

/// A named quantity over time; x = time [s], y = value.
struct TimeSeries {
  std::string name;
  std::vector<Eigen::Vector2d> points;
};

/// Quantities that share a value axis.
struct TimePanel {
  std::string title;
  std::string label;  ///< of the value axis, with its unit in square brackets
  std::vector<TimeSeries> series;
  bool logarithmic = false;
  bool from_zero = false;  ///< the axis includes 0
};

/// Quantities of one run over its time, e.g. D_k, its smoothed value and the gammas.
struct TimePlot {
  std::string title;
  std::string subtitle;
  std::vector<TimePanel> panels;
  bool of_estimators = false;  ///< the series are named after estimators and have their styles
  std::vector<std::pair<double, std::string>> events;  ///< time [s] and label of vertical lines
};

/// Writes one panel below the other with a common time axis. The value axes span all finite values
/// but for the outermost 0.2 % at either end. Error when the file cannot be written.
Result<void> write_time_plot(const std::filesystem::path& path, const TimePlot& plot);

}  // namespace aims
