// SPDX-License-Identifier: BSD-3-Clause
// Where neither IMU nor scans show how the robot turned.
#include <algorithm>

#include "estimator/aims/eskf_estimator.hpp"
#include "estimator/filter/outage.hpp"

namespace aims {

/// Follows how long neither IMU nor scans have shown the heading, over `segments_`.
void EskfEstimator::note_outage() {
  const double before = outage_;
  for (const InertialSegment& segment : segments_) {
    silence_ = segment.measured ? 0.0 : silence_ + to_seconds(segment.end - segment.begin);
    if (silence_ > kLongestBridge) outage_ = std::max(outage_, silence_);
  }
  if (outage_ == before) return;
  accept(belief_, with_unmeasured_heading(belief_, before, outage_));
  if (mapping_) accept(*mapping_, with_unmeasured_heading(*mapping_, before, outage_));
  health_.outage(outage_);
}

/// After an outage of IMU and LiDAR: turns the belief to the heading at which the scan fits best.
void EskfEstimator::find_heading() {
  const auto turn = lidar_update_.turn_onto_map(matching(), points_.to_match(), map_, calibration_,
                                                heading_reach(outage_));
  if (!turn) return;
  outage_ = 0.0;
  ++result_.counts["lidar.heading_searched"];
  belief_.state = turned(belief_.state, *turn);
  if (mapping_) mapping_->state = turned(mapping_->state, *turn);
  leg_free_.restart(matching(), time_);
}

}  // namespace aims
