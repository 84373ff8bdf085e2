// SPDX-License-Identifier: BSD-3-Clause
#include "bench/metrics/detector.hpp"

#include <algorithm>
#include <limits>

namespace aims {
namespace {

std::vector<double> sorted_scores(const LabelledRun& run, bool degenerate) {
  std::vector<double> scores;
  for (const LabelledScan& scan : run) {
    if (scan.degenerate == degenerate) scores.push_back(scan.score);
  }
  std::sort(scores.begin(), scores.end());
  return scores;
}

double wins(const std::vector<double>& positives, const std::vector<double>& negatives) {
  double sum = 0.0;
  auto below = negatives.begin();
  auto up_to = negatives.begin();
  for (const double score : positives) {
    while (below != negatives.end() && *below < score) ++below;
    up_to = std::max(up_to, below);
    while (up_to != negatives.end() && *up_to <= score) ++up_to;
    sum +=
        static_cast<double>(below - negatives.begin()) + 0.5 * static_cast<double>(up_to - below);
  }
  return sum;
}

/// Scans [begin, end) with the same truth.
struct LabelInterval {
  std::size_t begin = 0;
  std::size_t end = 0;
  bool degenerate = false;
};

std::vector<LabelInterval> intervals_of(const LabelledRun& run) {
  std::vector<LabelInterval> intervals;
  for (std::size_t i = 0; i < run.size(); ++i) {
    if (!intervals.empty() && intervals.back().degenerate == run[i].degenerate) {
      intervals.back().end = i + 1;
    } else {
      intervals.push_back({i, i + 1, run[i].degenerate});
    }
  }
  return intervals;
}

/// Merges short intervals of one class into their neighbours; those at the ends of the run are
/// kept, as their true length is unknown.
std::vector<LabelInterval> without_short(const LabelledRun& run,
                                         std::vector<LabelInterval> intervals, bool degenerate,
                                         Duration min_duration) {
  std::vector<LabelInterval> kept;
  for (std::size_t i = 0; i < intervals.size(); ++i) {
    const bool at_end = i == 0 || i + 1 == intervals.size();
    const LabelInterval& each = intervals[i];
    const bool is_short = !at_end && run[each.end].stamp - run[each.begin].stamp < min_duration;
    const bool flipped = each.degenerate == degenerate && is_short;
    const bool value = flipped ? !each.degenerate : each.degenerate;
    if (!kept.empty() && kept.back().degenerate == value) {
      kept.back().end = each.end;
    } else {
      kept.push_back({each.begin, each.end, value});
    }
  }
  return kept;
}

}  // namespace

AucTable::AucTable(std::span<const LabelledRun> runs) {
  const auto count = static_cast<Eigen::Index>(runs.size());
  wins_.setZero(count, count);
  degenerate_.setZero(count);
  others_.setZero(count);
  std::vector<std::vector<double>> positives;
  std::vector<std::vector<double>> negatives;
  for (const LabelledRun& run : runs) {
    positives.push_back(sorted_scores(run, true));
    negatives.push_back(sorted_scores(run, false));
  }
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    degenerate_[row] = static_cast<double>(positives[i].size());
    others_[row] = static_cast<double>(negatives[i].size());
    for (std::size_t j = 0; j < runs.size(); ++j) {
      wins_(row, static_cast<Eigen::Index>(j)) = wins(positives[i], negatives[j]);
    }
  }
}

std::optional<double> AucTable::auc() const {
  const double pairs = degenerate_.sum() * others_.sum();
  if (!(pairs > 0.0)) return std::nullopt;
  return wins_.sum() / pairs;
}

std::optional<double> AucTable::auc(std::span<const std::size_t> runs) const {
  Eigen::VectorXd times = Eigen::VectorXd::Zero(degenerate_.size());
  for (const std::size_t run : runs) times[static_cast<Eigen::Index>(run)] += 1.0;
  const double pairs = times.dot(degenerate_) * times.dot(others_);
  if (!(pairs > 0.0)) return std::nullopt;
  return times.dot(wins_ * times) / pairs;
}

std::vector<RocPoint> roc_curve(std::span<const LabelledRun> runs) {
  std::vector<std::pair<double, bool>> scans;
  for (const LabelledRun& run : runs) {
    for (const LabelledScan& scan : run) scans.emplace_back(scan.score, scan.degenerate);
  }
  std::sort(scans.begin(), scans.end(),
            [](const auto& a, const auto& b) { return a.first > b.first; });
  const auto degenerate =
      std::count_if(scans.begin(), scans.end(), [](const auto& scan) { return scan.second; });
  const auto others = static_cast<std::ptrdiff_t>(scans.size()) - degenerate;
  if (degenerate == 0 || others == 0) return {};
  std::vector<RocPoint> curve = {{std::numeric_limits<double>::infinity(), 0.0, 0.0}};
  std::ptrdiff_t detected = 0;
  std::ptrdiff_t false_alarms = 0;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    ++(scans[i].second ? detected : false_alarms);
    if (i + 1 < scans.size() && scans[i + 1].first == scans[i].first) continue;
    curve.push_back({scans[i].first,
                     static_cast<double>(false_alarms) / static_cast<double>(others),
                     static_cast<double>(detected) / static_cast<double>(degenerate)});
  }
  return curve;
}

RocPoint operating_point(std::span<const RocPoint> curve, double max_false_positive_rate) {
  const auto beyond =
      std::find_if(curve.begin(), curve.end(), [max_false_positive_rate](const RocPoint& point) {
        return point.false_positive_rate > max_false_positive_rate;
      });
  return beyond == curve.begin() ? curve.front() : *std::prev(beyond);
}

DetectionDelays detection_delays(const LabelledRun& run, double threshold, Duration min_duration) {
  // Short intervals that are not degenerate first, so that flickering counts as one interval.
  const std::vector<LabelInterval> intervals = without_short(
      run, without_short(run, intervals_of(run), false, min_duration), true, min_duration);
  DetectionDelays delays;
  for (std::size_t i = 1; i < intervals.size(); ++i) {
    if (!intervals[i].degenerate) continue;
    ++delays.onsets;
    for (std::size_t scan = intervals[i].begin; scan < intervals[i].end; ++scan) {
      if (run[scan].score < threshold) continue;
      delays.delays_s.push_back(to_seconds(run[scan].stamp - run[intervals[i].begin].stamp));
      break;
    }
  }
  return delays;
}

}  // namespace aims
