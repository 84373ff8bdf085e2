// SPDX-License-Identifier: BSD-3-Clause
#include "bench/tuning/held_out.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "bench/metrics/paired_test.hpp"
#include "bench/metrics/statistics.hpp"
#include "bench/scoring/score_list.hpp"
#include "bench/scoring/score_statistics.hpp"

namespace aims {
namespace {

constexpr double kSignificant = 0.05;

std::string changes_text(const Interval& interval) {
  return fmt::format("{} to {}", change_text(*interval.low), change_text(*interval.high));
}

/// The interval says better, and the test that these sequences are too few or too often alike.
bool may_be_better(const PairedGain& gain) {
  return gain.interval.low && *gain.interval.low > 0.0 && gain.p > kSignificant;
}

/// No gain makes up for a run that is lost.
bool loses_runs(const PairedGain& gain) { return gain.diverged > gain.diverged_before; }

/// Of the runs that the point saves where every one with the defaults diverged.
double p_of_saved(const PairedGain& gain) { return mcnemar_test(0, gain.saved_seeds).p; }

/// Of held-out sequences on which every run with the defaults diverged.
std::string saved_text(const PairedGain& gain) {
  const bool fewer = p_of_saved(gain) <= kSignificant;
  return fmt::format("{}: {} of {} held-out runs diverged instead of all (p = {:.2g}); {}",
                     fewer ? "use them" : "undecided", gain.diverged, gain.sequences,
                     p_of_saved(gain), kNoGain);
}

/// "ATE yaw" of "ate_yaw_m"; a key that has no title stands for itself.
std::string title_of(const std::string& key) {
  for (const Score& each : headline_scores()) {
    if (each.key == key) return std::string(each.title);
  }
  return key;
}

/// Those on which the defaults and the point have an objective.
std::vector<std::size_t> cases_of_both(const ResponseTable& table, const Objective& objective,
                                       std::size_t point) {
  std::vector<std::size_t> cases = cases_of(table, "");
  std::erase_if(cases, [&](std::size_t i) {
    const std::array one = {i};
    return !objective_at(table, objective, kDefaults, one) ||
           !objective_at(table, objective, point, one);
  });
  return cases;
}

/// What is needed of a gain besides significance: "1 cm and 5 %".
std::string small_text(const PairedGain& gain) {
  const double floor = smallest_change(gain.key, *gain.mean_before);
  return fmt::format(
      "the gain is beyond noise, but too small to matter (the mean would have to fall "
      "by more than {:.2g}{}{})",
      floor, gain.unit.empty() ? "" : " ", gain.unit);
}

/// The score as measured and the diverged runs on these cases.
void measure(const ResponseTable& table, std::size_t point, std::span<const std::size_t> cases,
             PairedGain& gain) {
  std::vector<double> before;  // where both have a score: medians are of the same runs
  std::vector<double> after;
  std::vector<double> both_before;  // where neither diverged
  std::vector<double> both_after;
  for (const std::size_t i : cases) {
    const RunScore& first = table.default_runs[i];
    const RunScore& second = table.runs[point][i];
    gain.diverged_before += first.diverged;
    gain.diverged += second.diverged;
    if (!first.value || !second.value) continue;
    before.push_back(*first.value);
    after.push_back(*second.value);
    if (first.diverged || second.diverged) continue;
    both_before.push_back(*first.value);
    both_after.push_back(*second.value);
  }
  gain.median_before = median(before);
  gain.median_after = median(after);
  gain.scored = after.size();
  gain.mean_before = mean(both_before);
  gain.mean_after = mean(both_after);
  gain.undiverged = both_after.size();
}

}  // namespace

std::string measured_text(const PairedGain& gain) {
  std::string text;
  if (gain.median_before && gain.median_after) {
    const std::string unit = gain.unit.empty() ? "" : " " + gain.unit;
    const std::string over = gain.scored < gain.sequences
                                 ? fmt::format(" over the {} with a score of both", gain.scored)
                                 : "";
    text = fmt::format("median {} {:.3g} -> {:.3g}{}{}, ", gain.score, *gain.median_before,
                       *gain.median_after, unit, over);
    if (gain.mean_before && gain.mean_after) {
      text += fmt::format("mean change {:+.2g}{}", *gain.mean_after - *gain.mean_before, unit);
      const bool all = gain.undiverged == gain.sequences;
      text += all ? ", " : fmt::format(" over the {} where neither diverged, ", gain.undiverged);
    }
  }
  return text + fmt::format("diverged runs {} -> {} of {}", gain.diverged_before, gain.diverged,
                            gain.sequences);
}

bool is_significant(const PairedGain& gain) {
  const Interval& interval = gain.interval;
  return gain.p <= kSignificant && interval.low && interval.high &&
         (*interval.low > 0.0 || *interval.high < 0.0);
}

bool is_small(const PairedGain& gain) {
  if (gain.diverged < gain.diverged_before || !gain.mean_before || !gain.mean_after) return false;
  return *gain.mean_before - *gain.mean_after <= smallest_change(gain.key, *gain.mean_before);
}

FrontVerdict front_verdict_of(std::span<const PairedGain> gains) {
  bool better = false;
  bool worse = false;
  for (const PairedGain& each : gains) {
    if (!each.gain || each.all_diverged || each.seeds < kFewestPairs) return FrontVerdict::kTooFew;
    if (loses_runs(each)) worse = true;
    if (loses_runs(each) || !is_significant(each)) continue;
    if (*each.gain < 0.0) worse = true;
    if (*each.gain > 0.0 && !is_small(each)) better = true;
  }
  if (better && worse) return FrontVerdict::kMixed;
  if (better) return FrontVerdict::kBetter;
  return worse ? FrontVerdict::kWorse : FrontVerdict::kNoDifference;
}

const char* name_of(FrontVerdict verdict) {
  switch (verdict) {
    case FrontVerdict::kBetter:
      return "better";
    case FrontVerdict::kWorse:
      return "worse";
    case FrontVerdict::kMixed:
      return "better and worse";
    case FrontVerdict::kNoDifference:
      return "no significant difference";
    case FrontVerdict::kTooFew:
      break;
  }
  return "too few seeds";
}

PairedGain paired_gain(const ResponseTable& table, const Objective& planned, std::size_t point) {
  const Objective objective = objective_for(planned, table);
  const SeedGroups seeds = cases_by_seed(table, cases_of_both(table, objective, point));
  std::vector<std::size_t> cases;
  for (const auto& of : seeds) cases.insert(cases.end(), of.begin(), of.end());
  PairedGain result;
  result.sequences = cases.size();
  result.seeds = seeds.size();
  result.saved_seeds = static_cast<std::size_t>(std::ranges::count_if(seeds, [&](const auto& of) {
    return std::ranges::any_of(of, [&](std::size_t i) { return !table.runs[point][i].diverged; });
  }));
  result.all_diverged = all_diverged(table);
  result.defaults_diverged = defaults_all_diverged(table);
  result.score = title_of(objective.score);
  result.key = objective.score;
  result.unit = unit_of(objective.score);
  measure(table, point, cases, result);
  if (result.defaults_diverged) return result;
  const auto gain = [&](std::span<const std::size_t> some) {
    return gain_over(objective_at(table, objective, kDefaults, some),
                     objective_at(table, objective, point, some));
  };
  result.gain = gain(cases);
  if (seeds.size() < kFewestPairs) return result;
  std::vector<double> differences;  // of logarithms, a seed each: less is better
  for (const auto& of : seeds) {
    const double before = objective_at(table, objective, kDefaults, of).value_or(0.0);
    const double after = objective_at(table, objective, point, of).value_or(0.0);
    const bool positive = before > 0.0 && after > 0.0;
    differences.push_back(positive ? std::log(after / before) : after - before);
  }
  result.p = paired_test(differences).p;
  result.interval = bootstrap_interval(
      seeds.size(), [&](std::span<const std::size_t> drawn) { return gain(joined(seeds, drawn)); },
      1);
  return result;
}

Verdict verdict_of(const PairedGain& held_out) {
  if (held_out.defaults_diverged && !held_out.all_diverged) {
    return p_of_saved(held_out) <= kSignificant ? Verdict::kUseThem : Verdict::kUndecided;
  }
  if (!held_out.gain || held_out.all_diverged || held_out.seeds < 2) {
    return Verdict::kUndecided;
  }
  if (loses_runs(held_out)) return Verdict::kDoNotUse;
  if (held_out.seeds < kFewestPairs) {
    return *held_out.gain < 0.0 ? Verdict::kDoNotUse : Verdict::kUndecided;
  }
  if (is_significant(held_out)) {
    return *held_out.gain > 0.0 && !is_small(held_out) ? Verdict::kUseThem : Verdict::kDoNotUse;
  }
  return may_be_better(held_out) ? Verdict::kUndecided : Verdict::kDoNotUse;
}

std::string verdict_text(const PairedGain& held_out) {
  if (held_out.sequences == 0) {
    return "not validated: no sequence was held out, and a gain on the sequences that were tuned "
           "on may be overfitting";
  }
  if (held_out.all_diverged) {
    return "undecided: every held-out run diverged or failed, with the defaults and with the tuned "
           "values";
  }
  if (held_out.defaults_diverged) return saved_text(held_out);
  if (!held_out.gain) return "not validated: the objective has no gain on the held-out sequences";
  const std::string change = change_text(*held_out.gain);
  if (held_out.seeds == 1) {
    return fmt::format("nothing can be concluded from one held-out seed ({}; objective {})",
                       measured_text(held_out), change);
  }
  const std::string on =
      fmt::format("{}; objective {} on {} held-out sequences of {} seeds", measured_text(held_out),
                  change, held_out.sequences, held_out.seeds);
  if (loses_runs(held_out)) {
    return fmt::format("do not use them: more held-out runs diverge: {}", on);
  }
  if (held_out.seeds < kFewestPairs) {
    const char* what = verdict_of(held_out) == Verdict::kDoNotUse ? "do not use them" : "undecided";
    return fmt::format("{}: {}, too few for an interval ({} seeds are needed)", what, on,
                       kFewestPairs);
  }
  const std::string figures =
      fmt::format("95 % interval {}, p = {:.2g}", changes_text(held_out.interval), held_out.p);
  if (is_significant(held_out)) {
    const bool better = *held_out.gain > 0.0;
    if (better && is_small(held_out)) {
      return fmt::format("do not use them: {}: {} ({})", small_text(held_out), on, figures);
    }
    return fmt::format("{}: {} ({})", better ? "use them" : "do not use them", on, figures);
  }
  if (may_be_better(held_out)) {
    return fmt::format(
        "undecided: {} ({}); {}", on, figures,
        is_small(held_out)
            ? "the gain so far is too small to matter, so keep the defaults"
            : "decide in a plan of its own, on more seeds that were never looked at");
  }
  return fmt::format("do not use them: no significant difference from the defaults: {} ({})", on,
                     figures);
}

std::string change_text(double gain) {
  const double percent = 100.0 * std::abs(gain);
  return fmt::format("{:.{}f} % {}", percent, percent < 9.95 ? 1 : 0,
                     gain < 0.0 ? "worse" : "better");
}

}  // namespace aims
