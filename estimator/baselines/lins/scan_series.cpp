// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/lins/scan_series.hpp"

#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>
#include <limits>

namespace aims::lins {
namespace {

using Series = ReportedSeries<ScanReport>;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

int iterations(const ScanReport& scan) {
  const int mapping = scan.mapping ? scan.mapping->iterations : 0;
  return scan.odometry.update.iterations + mapping;
}

double smallest_eigenvalue_of(const Update& update) {
  if (update.iterations == 0 || !update.last.HtH.allFinite()) return kNone;
  const Eigen::SelfAdjointEigenSolver<Matrix6> solver(update.last.HtH, Eigen::EigenvaluesOnly);
  return solver.eigenvalues()[0];
}

double residual_rms(const Update& update) {
  const int count = update.last.lines + update.last.planes;
  return count > 0 ? std::sqrt(update.last.squared_norm / count) : kNone;
}

constexpr std::array kSeries = {
    Series{"points_in", "-", "finite points in range",
           [](const ScanReport& s) { return double(s.points_in); }},
    Series{"ground_points", "-", "returns of the ground",
           [](const ScanReport& s) { return double(s.ground); }},
    Series{"segmented_points", "-", "returns of kept segments",
           [](const ScanReport& s) { return double(s.segmented); }},
    Series{"iterations", "-", "of filter and mapping; 0: no update",
           [](const ScanReport& s) { return double(iterations(s)); }},
    Series{"filter_iterations", "-", "of the filter",
           [](const ScanReport& s) { return double(s.odometry.update.iterations); }},
    Series{"converged", "-", "1: the filter's last step was small",
           [](const ScanReport& s) { return s.odometry.update.converged ? 1.0 : 0.0; }},
    Series{"diverged", "-", "1: the filter diverged, the scans alone gave the motion",
           [](const ScanReport& s) { return s.odometry.update.diverged ? 1.0 : 0.0; }},
    Series{"plane_matches", "-", "planes of the last scan in the last iteration",
           [](const ScanReport& s) { return double(s.odometry.update.last.planes); }},
    Series{"edge_matches", "-", "lines of the last scan in the last iteration",
           [](const ScanReport& s) { return double(s.odometry.update.last.lines); }},
    Series{"residual_rms", "m", "weighted distances in the last iteration",
           [](const ScanReport& s) { return residual_rms(s.odometry.update); }},
    Series{"filter_smallest_eigenvalue", "-",
           "smallest eigenvalue of H^T H in the last iteration: position, rotation",
           [](const ScanReport& s) { return smallest_eigenvalue_of(s.odometry.update); }},
    Series{"mapping_matches", "-", "lines and planes of the map; NaN: scan not registered",
           [](const ScanReport& s) {
             return s.mapping ? double(s.mapping->lines + s.mapping->planes) : kNone;
           }},
    Series{"mapping_smallest_eigenvalue", "-",
           "smallest eigenvalue of A^T A in the first iteration, scan to map",
           [](const ScanReport& s) { return s.mapping ? smallest_eigenvalue(*s.mapping) : kNone; }},
    Series{"mapping_removed_directions", "-", "degenerate directions that do not move",
           [](const ScanReport& s) {
             return s.mapping ? double(s.mapping->directions.removed) : kNone;
           }},
};

}  // namespace

std::vector<SeriesInfo> scan_series() { return series_of(kSeries); }

ScanRow row_of(const ScanReport& scan, Time stamp) {
  return {stamp, std::nullopt, values_of(kSeries, scan)};
}

}  // namespace aims::lins
