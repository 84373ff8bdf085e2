// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "estimator/interface/health.hpp"

namespace aims {

/// How long an estimator called itself what, after its start.
struct HealthSummary {
  bool judged = false;                         ///< false: the estimator does not judge itself
  HealthState worst = HealthState::kStarting;  ///< kStarting: it never started
  double healthy_s = 0.0;
  double degraded_s = 0.0;
  double invalid_s = 0.0;
  std::map<std::string, double> reasons;  ///< time [s] of each
  HealthRow last;                         ///< of the rows, where there is one
  std::string too_short;                  ///< why nothing of it tells anything; empty: it does
  std::vector<std::string> of_recording;  ///< reasons that concern all of it, without a time
};

/// Adds the row that follows those added before; each holds until the next.
void add_health(const HealthRow& row, HealthSummary& summary);

/// The rows with the warnings among their reasons, degraded at best; those before the start as they
/// are.
std::vector<HealthRow> warned(std::span<const HealthRow> rows,
                              const std::vector<std::string>& warnings);

/// The summary of all rows.
HealthSummary health_summary(const std::vector<HealthRow>& rows);

/// Time [s] after that instant in which an estimator called itself healthy.
double healthy_after(const std::vector<HealthRow>& rows, Time begin);

}  // namespace aims
