// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <limits>

#include "estimator/baselines/features/feature_solver.hpp"
#include "estimator/diagnostics.hpp"

namespace aims::features {

/// The series of the registration to the map, `Report::mapping`; NaN where a scan was not.
template <class Report>
constexpr std::array<ReportedSeries<Report>, 3> mapping_series() {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  return {{
      {"mapping_matches", "-", "lines and planes of the map; NaN: scan not registered",
       [](const Report& s) {
         return s.mapping ? double(s.mapping->lines + s.mapping->planes) : kNone;
       }},
      {"mapping_smallest_eigenvalue", "-",
       "smallest eigenvalue of A^T A in the first iteration, scan to map",
       [](const Report& s) { return s.mapping ? smallest_eigenvalue(*s.mapping) : kNone; }},
      {"mapping_removed_directions", "-", "degenerate directions that do not move",
       [](const Report& s) { return s.mapping ? double(s.mapping->directions.removed) : kNone; }},
  }};
}

/// The series of the loops, `Report::loops`.
template <class Report>
constexpr std::array<ReportedSeries<Report>, 1> loop_series() {
  return {{{"loops", "-", "loops closed so far", [](const Report& s) { return double(s.loops); }}}};
}

}  // namespace aims::features
