// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scoring/health_time.hpp"

#include <algorithm>

namespace aims {
namespace {

/// Time [s] of the summary in that state.
double& time_in(HealthState state, HealthSummary& summary) {
  if (state == HealthState::kInvalid) return summary.invalid_s;
  return state == HealthState::kDegraded ? summary.degraded_s : summary.healthy_s;
}

}  // namespace

void add_health(const HealthRow& row, HealthSummary& summary) {
  const HealthRow& before = summary.last;
  if (summary.judged && before.state != HealthState::kStarting) {
    const double seconds = to_seconds(row.stamp - before.stamp);
    time_in(before.state, summary) += seconds;
    for (const std::string& reason : before.reasons) summary.reasons[reason] += seconds;
  }
  summary.judged = true;
  summary.worst = std::max(summary.worst, row.state);
  summary.last = row;
}

std::vector<HealthRow> warned(std::span<const HealthRow> rows,
                              const std::vector<std::string>& warnings) {
  std::vector<HealthRow> marked(rows.begin(), rows.end());
  for (HealthRow& row : marked) {
    if (warnings.empty() || row.state == HealthState::kStarting) continue;
    row.state = std::max(row.state, HealthState::kDegraded);
    row.reasons.insert(row.reasons.end(), warnings.begin(), warnings.end());
  }
  return marked;
}

HealthSummary health_summary(const std::vector<HealthRow>& rows) {
  HealthSummary summary;
  for (const HealthRow& row : rows) add_health(row, summary);
  return summary;
}

double healthy_after(const std::vector<HealthRow>& rows, Time begin) {
  double seconds = 0.0;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const Time from = std::max(rows[i - 1].stamp, begin);
    if (rows[i - 1].state == HealthState::kHealthy && rows[i].stamp > from) {
      seconds += to_seconds(rows[i].stamp - from);
    }
  }
  return seconds;
}

}  // namespace aims
