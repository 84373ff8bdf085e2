// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "render/plots/plot.hpp"

namespace aims {

/// A value at a point of a plane; no value leaves the cell grey.
struct FieldCell {
  double x = 0.0;
  double y = 0.0;
  std::optional<double> value;
};

/// Cells of a grid: every x with every y, in any order.
struct FieldPanel {
  std::string title;
  std::vector<FieldCell> cells;
};

/// A value over two quantities, e.g. an error over two parameters.
struct FieldPlot {
  std::string title;
  std::string subtitle;
  std::string x_label;  ///< with its unit in square brackets
  std::string y_label;
  std::string value_label;
  bool logarithmic_x = false;
  bool logarithmic_y = false;
  bool logarithmic_value = false;
  std::vector<Mark> marks;  ///< on every panel
  std::vector<FieldPanel> panels;
};

/// Writes square panels side by side, each cell coloured by its value on a scale that all panels
/// share; a cell reaches halfway to its neighbours. Error when the file (.png, .svg, .pdf) cannot
/// be written.
Result<void> write_field_plot(const std::filesystem::path& path, const FieldPlot& plot);

}  // namespace aims
