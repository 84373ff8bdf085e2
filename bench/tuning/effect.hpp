// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "bench/tuning/objective.hpp"

namespace aims {

/// How much an objective differs between the points of a table, and whether by more than seeds
/// scatter.
struct Effect {
  std::size_t points = 0;  ///< within their ranges, that have an objective
  double least = 0.0;      ///< objective over all sequences
  double most = 0.0;
  /// Permutation test in randomized blocks, as that of Friedman (1937): the points are exchanged
  /// within each seed; the fraction of all arrangements, of 199 draws where there are many, in
  /// which the variance over points of their sums over seeds, of the objective's logarithm, is as
  /// large. None with one seed.
  std::optional<double> p;
  std::size_t arrangements = 0;  ///< that were looked at, all there are; 0: draws
  /// Whether the test could resolve an effect that is alike on all seeds: not with few seeds and
  /// points, or many equal ones.
  bool testable = true;
  std::size_t cases = 0;
  std::size_t saturated = 0;  ///< cases on which every run diverged and counts by the penalty
  bool small = false;         ///< too little to matter, as in comparisons (`smallest_change`)
  bool of_one_point = false;  ///< resolved, and not without the point farthest from the mean
  bool one_is_worse = false;  ///< that point is worse than the mean: the others tell no best

  bool is_none() const;
  /// Beyond the scatter of seeds; with one seed, whose scatter is unknown, more than 5 %.
  bool is_resolved() const;
  /// Resolved, and not by a single worse point alone, without which seeds scatter as much.
  bool tells_best() const { return is_resolved() && !(of_one_point && one_is_worse); }
};

/// With `family` over its scenarios alone.
Effect effect_of(const ResponseTable& table, const Objective& objective,
                 const std::string& family = "");

/// "The objective lies between 0.93 and 1.2 at the 16 points (29 %)." and what that is worth.
std::string text_of(const Effect& effect);

/// Per parameter, whether no point contradicts that it has no effect, and the points can tell: all
/// have the same score in every run, or those that differ in it alone have, are at least half of
/// all, and reach over at least half of what the points reach over of each parameter.
std::vector<bool> without_effect(const ResponseTable& table);

/// Per parameter, whether points that differ in it alone, of which there are some, have the same
/// score in every run: it may have no effect, which these points alone need not show.
std::vector<bool> alike_in_pairs(const ResponseTable& table);

/// Whether no value lies outside its range, as a default may.
bool is_inside(const ResponseTable& table, const std::vector<double>& values);

}  // namespace aims
