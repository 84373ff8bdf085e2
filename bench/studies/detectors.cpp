// SPDX-License-Identifier: BSD-3-Clause
#include "bench/studies/detectors.hpp"

#include <algorithm>
#include <cmath>

#include "bench/metrics/localizability_scores.hpp"
#include "bench/metrics/statistics.hpp"

namespace aims {
namespace {

/// Spells of degeneracy shorter than this are no onset: flicker of the truth around its limit.
constexpr Duration kShortestSpell = kSecond / 2;
constexpr std::uint64_t kBootstrapSeed = 1;
/// Points that a curve keeps.
constexpr std::size_t kCurvePoints = 400;

/// The runs for one index and one level; larger scores mean degeneracy.
std::vector<LabelledRun> labelled(std::span<const DetectorRun* const> runs, std::size_t index,
                                  const DegeneracyLevel& level) {
  const double sign = degeneracy_indices()[index].high_is_degenerate ? 1.0 : -1.0;
  std::vector<LabelledRun> result;
  for (const DetectorRun* run : runs) {
    LabelledRun& each = result.emplace_back();
    for (const DetectorScan& scan : run->scans) {
      const double value = sign * scan.values[index];
      if (!std::isfinite(value)) continue;
      each.push_back({scan.stamp, value, scan.equivalent_returns < level.equivalent_returns});
    }
  }
  return result;
}

std::vector<RocPoint> thinned_curve(const std::vector<RocPoint>& curve) {
  if (curve.size() <= kCurvePoints) return curve;
  std::vector<RocPoint> kept;
  for (std::size_t i = 0; i < kCurvePoints; ++i) {
    kept.push_back(curve[i * (curve.size() - 1) / (kCurvePoints - 1)]);
  }
  return kept;
}

/// What depends on a threshold: the fraction of detections and the delays.
void score_operating_point(std::span<const LabelledRun> runs, bool high_is_degenerate,
                           DetectorScore& score) {
  const std::vector<RocPoint> curve = roc_curve(runs);
  if (curve.empty()) return;
  const RocPoint point = operating_point(curve, kFalseAlarms);
  score.detections = point.true_positive_rate;
  if (std::isfinite(point.threshold)) {
    score.threshold = high_is_degenerate ? point.threshold : -point.threshold;
  }
  std::vector<double> delays;
  for (const LabelledRun& run : runs) {
    const DetectionDelays each = detection_delays(run, point.threshold, kShortestSpell);
    score.onsets += each.onsets;
    score.missed += each.missed();
    delays.insert(delays.end(), each.delays_s.begin(), each.delays_s.end());
  }
  score.median_delay_s = median(delays);
  score.curve = thinned_curve(curve);
}

DetectorScore score_one(std::span<const DetectorRun* const> runs, std::size_t index,
                        const DegeneracyLevel& level) {
  const DegeneracyIndex& judged = degeneracy_indices()[index];
  const std::vector<LabelledRun> series = labelled(runs, index, level);
  DetectorScore score;
  score.index = judged.name;
  score.level = level.name;
  score.runs = static_cast<int>(runs.size());
  for (const LabelledRun& run : series) {
    score.scans += static_cast<int>(run.size());
    score.degenerate += static_cast<int>(
        std::count_if(run.begin(), run.end(), [](const auto& scan) { return scan.degenerate; }));
  }
  const AucTable table(series);
  score.auc = table.auc();
  if (!score.auc) return score;
  score.auc_interval = bootstrap_interval(
      series.size(), [&table](std::span<const std::size_t> picked) { return table.auc(picked); },
      kBootstrapSeed);
  score_operating_point(series, judged.high_is_degenerate, score);
  return score;
}

/// Whether any scan has a value of the index.
bool is_computed(std::span<const DetectorRun* const> runs, std::size_t index) {
  return std::ranges::any_of(runs, [index](const DetectorRun* run) {
    return std::ranges::any_of(run->scans, [index](const DetectorScan& scan) {
      return std::isfinite(scan.values[index]);
    });
  });
}

void score_set(std::span<const DetectorRun* const> runs, const std::string& scenario,
               std::vector<DetectorScore>& scores) {
  for (const DegeneracyLevel& level : kDegeneracyLevels) {
    for (std::size_t index = 0; index < degeneracy_indices().size(); ++index) {
      if (!is_computed(runs, index)) continue;
      scores.push_back(score_one(runs, index, level));
      scores.back().scenario = scenario;
    }
  }
}

}  // namespace

const std::vector<DegeneracyIndex>& degeneracy_indices() {
  static const std::vector<DegeneracyIndex> indices = {
      {"D", true, "paper, eq. (7)"},
      {"D_smoothed", true, "paper, eq. (12)"},
      {"O_lidar", false, "paper, eq. (4)"},
      {"O_lidar_prior", false, "paper, eq. (4)"},
      {"C_IL", true, "paper, eqs. (6), (7)"},
      {"C_IL_imu", true, "paper, eq. (6), against the IMU alone"},
      {"C_IL_imu_legs", true, "eq. (6) against IMU and legs"},
      {"smallest_eigenvalue", false, "Zhang, Kaess and Singh 2016"},
      {"odometry_smallest_eigenvalue", false, "Zhang, Kaess and Singh 2016"},
      {"edge_smallest_eigenvalue", false, "Zhang, Kaess and Singh 2016"},
      {"mapping_smallest_eigenvalue", false, "Zhang, Kaess and Singh 2016"},
      {"condition_number", true, "Hinduja, Ho and Kaess 2019"},
      {"localizability", false, "Tuna, Nubert, Nava, Khattak and Hutter 2023"},
      {"is_degenerate", true, "Shan, Englot, Meyers, Wang, Ratti and Rus 2020"},
      {"weak_weight", false, "this project: real fraction along the weakest axis"},
      {"weak_tilt", false, "this project: tilt of the planes towards the weakest axis"},
      {"points_used", false, "usual practice"}};
  return indices;
}

DetectorRun detector_run(const Diagnostics& diagnostics, std::span<const Localizability> truth,
                         Duration tolerance) {
  std::vector<Time> stamps;
  for (const Localizability& scan : truth) stamps.push_back(scan.stamp);
  DetectorRun run;
  for (std::size_t i = 0; i < diagnostics.scans.size(); ++i) {
    if (!diagnostics.updated(i)) {
      ++run.without_update;
      continue;
    }
    const auto nearest = nearest_stamp(stamps, diagnostics.scans[i].stamp, tolerance);
    if (!nearest) {
      ++run.without_truth;
      continue;
    }
    DetectorScan& each = run.scans.emplace_back();
    each.stamp = diagnostics.scans[i].stamp;
    each.equivalent_returns = truth[*nearest].equivalent_returns;
    for (const DegeneracyIndex& index : degeneracy_indices()) {
      each.values.push_back(diagnostics.value(i, index.name));
    }
  }
  return run;
}

std::vector<DetectorScore> score_detectors(std::span<const DetectorRun> runs) {
  std::vector<const DetectorRun*> all;
  std::vector<std::string> scenarios;
  for (const DetectorRun& run : runs) {
    all.push_back(&run);
    if (std::find(scenarios.begin(), scenarios.end(), run.scenario) == scenarios.end()) {
      scenarios.push_back(run.scenario);
    }
  }
  std::vector<DetectorScore> scores;
  score_set(all, "", scores);
  for (const std::string& scenario : scenarios) {
    std::vector<const DetectorRun*> of_scenario;
    for (const DetectorRun* run : all) {
      if (run->scenario == scenario) of_scenario.push_back(run);
    }
    score_set(of_scenario, scenario, scores);
  }
  return scores;
}

}  // namespace aims
