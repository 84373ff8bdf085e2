// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "bench/metrics/statistics.hpp"
#include "bench/tuning/objective.hpp"

namespace aims {

/// By how much a point reduces the objective of the defaults on the sequences of a table.
struct PairedGain {
  std::size_t sequences = 0;    ///< on which both have an objective
  std::size_t seeds = 0;        ///< of those sequences, which are independent from seed to seed
  std::size_t saved_seeds = 0;  ///< of them, those on which not every run of the point diverged
  std::optional<double> gain;   ///< reduction of the objective, as a fraction of the defaults'
  /// 95 %, of the gain: bootstrap over seeds, each with all its sequences and both runs of each;
  /// empty below `kFewestPairs` seeds.
  Interval interval;
  bool all_diverged = false;        ///< every run, of both
  bool defaults_diverged = false;   ///< every run with the defaults: there is no gain
  std::size_t diverged = 0;         ///< runs of the point
  std::size_t diverged_before = 0;  ///< runs with the defaults
  std::string score = {};           ///< what the objective is a statistic of: "ATE yaw"
  std::string key = {};             ///< of scores.json
  std::string unit = {};
  std::size_t scored = 0;  ///< sequences on which both have a score, whether they diverged or not
  std::optional<double> median_before;  ///< over them, as measured, with the defaults
  std::optional<double> median_after;   ///< with the values of the point
  std::optional<double> mean_before;    ///< over the sequences on which neither diverged
  std::optional<double> mean_after;     ///< over the same
  std::size_t undiverged = 0;           ///< those sequences
  double p = 1.0;  ///< of the sign-flip test over seeds (bench/metrics/paired_test.hpp)
};

/// "median ATE yaw 0.384 -> 0.215 m, mean change -0.12 m, diverged runs 9 -> 6 of 10": the defaults
/// before, the point after.
std::string measured_text(const PairedGain& gain);

PairedGain paired_gain(const ResponseTable& table, const Objective& objective, std::size_t point);

/// What the held-out sequences say of tuned values.
enum class Verdict {
  kUseThem,  ///< better: the interval and the test exclude zero, and not small; or, where every run
             ///< with the defaults diverged, significantly fewer diverge (McNemar's test)
  kDoNotUse,   ///< worse, or no difference that is significant
  kUndecided,  ///< no sequences, or too few to conclude
};

Verdict verdict_of(const PairedGain& held_out);

/// True when interval and test exclude zero.
bool is_significant(const PairedGain& gain);

/// That the score falls by too little to matter (`smallest_change`, as in comparisons), and no
/// fewer runs diverge.
bool is_small(const PairedGain& gain);

/// Of a point in several objectives: better than the defaults significantly in one and in none
/// worse; "worse" likewise.
enum class FrontVerdict { kBetter, kWorse, kMixed, kNoDifference, kTooFew };
FrontVerdict front_verdict_of(std::span<const PairedGain> gains);
const char* name_of(FrontVerdict verdict);

/// The verdict with its figures, on one line: "do not use them: median ATE yaw 0.3 -> 0.33 m,
/// diverged runs 0 -> 0 of 16; objective 8.7 % worse on 16 held-out sequences of 8 seeds (95 %
/// interval 3.1 to 14 % worse, p = 0.016)".
std::string verdict_text(const PairedGain& held_out);

/// "8.7 % worse", "12 % better".
std::string change_text(double gain);

}  // namespace aims
