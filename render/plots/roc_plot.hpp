// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "core/error.hpp"

namespace aims {

/// The ROC curve of one detector; x = false-alarm rate, y = detection rate.
struct RocSeries {
  std::string name;
  std::vector<Eigen::Vector2d> points;
};

/// Detectors of the same event. Without series a note replaces the curves.
struct RocPanel {
  std::string title;
  std::vector<RocSeries> series;
};

/// Panels side by side, one per event.
struct RocPlot {
  std::string title;
  std::string subtitle;
  std::vector<RocPanel> panels;
};

/// Writes square panels side by side, each with its own legend below and the line of a random
/// guess. The k-th detector has the same line in every panel, by its place in the panel. Error when
/// the file cannot be written.
Result<void> write_roc_plot(const std::filesystem::path& path, const RocPlot& plot);

}  // namespace aims
