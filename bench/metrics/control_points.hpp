// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "bench/metrics/association.hpp"

namespace aims {

/// Score over surveyed points by the rule of the Hilti SLAM Challenge 2022.
struct ControlPointScore {
  int points = 0;      ///< of the truth
  int reached = 0;     ///< of these, with an estimate at their time
  double score = 0.0;  ///< 0 to 100
};

/// Sum of what each aligned pair earns: 10 below 1 cm, 6 below 3 cm, 3 below 6 cm, 1 below 10 cm;
/// of 10 for each of `points` [%]. Source: batch_evaluation.py of the challenge of 2022. 0 without
/// points.
double control_point_score(std::span<const PosePair> aligned, int points);

}  // namespace aims
