// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/metrics/statistics.hpp"
#include "bench/studies/suite.hpp"

namespace aims {

/// Smallest headline ATE at which an estimator can break, as a fraction of the length of the route
/// [-].
inline constexpr double kMinBreakError = 0.005;

/// One estimator at one level of a family, over seeds.
struct FamilyPoint {
  double level = 0.0;
  std::optional<double> ate_m;   ///< median of the ATE aligned by heading and translation
  Interval ate_interval;         ///< of the median, 95 %
  std::optional<double> m_list;  ///< median over all segments [%]
  Interval m_list_interval;      ///< of the median, 95 %
  double distance_m = 0.0;       ///< length of the route
  double success_rate = 0.0;     ///< in [0, 1]
  Interval success_interval;     ///< 95 %
  std::size_t runs = 0;          ///< valid ones
  std::size_t invalid = 0;       ///< left out
  bool partial = false;          ///< of some run the estimate lacks a part
};

/// One estimator over the levels of a family.
struct FamilyCurve {
  std::string estimator;
  std::vector<FamilyPoint> points;  ///< by level
  std::vector<double> breaks_at;    ///< at most one level on either side of the mildest
};

struct FamilyResult {
  std::string name;
  std::string level_unit;
  double mildest = 0.0;  ///< level from which the others are judged
  /// Levels that the seeds do not tell apart from it, so that one of them may be as mild; none when
  /// these are too few to tell.
  std::optional<std::vector<double>> alike;
  /// Median over seeds of the scans' median equivalent returns along the weak axis, per level.
  std::vector<std::optional<double>> equivalent_returns;
  std::vector<FamilyCurve> curves;
};

/// The families of the suite that have finished runs at two levels or more.
///
/// The mildest level is the one with the most successes over all estimators, and among equals that
/// with the smallest median ATE (geometric mean over estimators). A level differs from it when the
/// sign-flip test over seeds finds a change of the successes of all estimators, or of the mean
/// logarithm of their ATE. An estimator breaks at the first
/// level, going away from the mildest on either side, where it succeeds in less than half of the
/// runs, or where its median ATE exceeds both twice that at the mildest level and `kMinBreakError`
/// of the distance: twice a few centimetres is no break.
std::vector<FamilyResult> family_results(const Suite& suite);

/// "2, 3", "-" for none, or that the seeds are too few.
std::string alike_text(const FamilyResult& family);

/// The families as suite.json holds them.
Json families_json(const std::vector<FamilyResult>& families);

}  // namespace aims
