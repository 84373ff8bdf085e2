// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

namespace aims {

/// Scores over surveyed points by the rules of the Hilti SLAM Challenges.
struct ControlPointScore {
  int points = 0;           ///< of the truth
  int reached = 0;          ///< of these, with an estimate at their time
  double score = 0.0;       ///< of 2022, 0 to 100
  double score_2023 = 0.0;  ///< of 2023, 0 to 100
};

/// Sum of what each position error [m] of aligned pairs earns: 10 below 1 cm, 6 below 3 cm, 3 below
/// 6 cm, 1 below 10 cm; of 10 for each of `points` [%]. Source: batch_evaluation.py of the
/// challenge of 2022. 0 without points.
double control_point_score(std::span<const double> errors, int points);

/// The same with 20 below 5 mm, 10 below 1 cm, 6 below 3 cm, 5 below 6 cm, 3 below 10 cm, 1 below
/// 40 cm, of 20 for each. Source: batch_evaluation.py of the challenge of 2023, single session.
double control_point_score_2023(std::span<const double> errors, int points);

}  // namespace aims
