// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scoring/estimator_rows.hpp"

namespace aims {

void add_rows(const EstimatorRows& rows, EstimatorTotals& totals) {
  for (const StampedPose& each : rows.poses) {
    if (totals.poses == 0) {
      totals.first_pose = each.pose;
    } else {
      totals.path_m += (each.pose.translation - totals.last_pose.translation).norm();
    }
    totals.last_pose = each.pose;
    ++totals.poses;
  }
  totals.scans += rows.scans.size();
  for (const HealthRow& each : rows.health) add_health(each, totals.health);
}

}  // namespace aims
