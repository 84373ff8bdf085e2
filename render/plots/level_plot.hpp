// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/error.hpp"

namespace aims {

/// A value at a level with its interval; no value leaves a gap.
struct LevelPoint {
  double level = 0.0;
  std::optional<double> value;
  std::optional<double> low;
  std::optional<double> high;
};

struct LevelCurve {
  std::string name;
  std::vector<LevelPoint> points;    ///< drawn with markers
  std::vector<LevelPoint> fit = {};  ///< a thin line without markers, with its interval; or none
};

/// Curves that share a value axis.
struct LevelPanel {
  std::string title;
  std::string label;  ///< of the value axis, with its unit in square brackets
  std::vector<LevelCurve> curves;
  bool logarithmic = false;
  bool rate = false;  ///< the axis spans 0 to 1
};

/// Scores over what varies in a family of scenarios.
struct LevelPlot {
  std::string title;
  std::string subtitle;
  std::string level_label;  ///< with its unit in square brackets
  bool logarithmic_levels = false;
  bool unjoined = false;       ///< markers without lines between them
  bool of_estimators = false;  ///< the curves are named after estimators and have their colours
  std::vector<LevelPanel> panels;
};

/// Writes one panel below the other with a common level axis. Curve i of every panel has the same
/// colour; intervals are vertical lines, a little apart where they would hide one another, of fits
/// two dashed lines. Error
/// when the file (.png, .svg, .pdf) cannot be written.
Result<void> write_level_plot(const std::filesystem::path& path, const LevelPlot& plot);

}  // namespace aims
