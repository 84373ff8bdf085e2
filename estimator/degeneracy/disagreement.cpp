// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/degeneracy/disagreement.hpp"

#include <algorithm>
#include <cmath>

namespace aims {
namespace {

/// Legs that are silent for longer say nothing of the way in between [s].
constexpr double kLegSilence = 0.05;
/// An axis that a scan sees with less certainty is not compared.
constexpr double kSeen = 0.5;
/// Share of the window in which the feet must agree for the legs to be consistent.
constexpr double kFirmShare = 0.8;

}  // namespace

void Disagreement::add(const LegMotionTold& told) {
  if (last_leg_) {
    const double dt = to_seconds(told.stamp - last_leg_->stamp);
    now_.leg_way += dt * told.velocity;
    now_.leg_noise += dt * told.noise;
    if (dt > kLegSilence) now_.leg_gap += dt;
    if (told.firm) now_.firm += dt;
  }
  last_leg_ = told;
}

/// A streak belongs to a direction, and goes with it when the axes are taken anew.
void Disagreement::carry_streaks_over(const Eigen::Matrix3d& axes) {
  if (now_.fix.axes == axes) return;
  streak_ = (axes.transpose() * now_.fix.axes).cwiseAbs2() * streak_;
}

/// How far the difference of the ways lies beyond the gate, along each axis of the later fix: 1 at
/// the gate; 0 where there is nothing to compare.
Eigen::Vector3d Disagreement::excess(const Instant& from, const Instant& to,
                                     const Eigen::Matrix3d& leg_drift) const {
  const double time = to_seconds(to.fix.stamp - from.fix.stamp);
  const Eigen::Vector3d difference =
      (to.fix.position - from.fix.position) - (to.leg_way - from.leg_way);
  const Eigen::Matrix3d covariance = to.fix.covariance + from.fix.covariance +
                                     time * time * leg_drift + (to.leg_noise - from.leg_noise);
  const double matching = config_.lidar_sigma * config_.lidar_sigma;
  Eigen::Vector3d result = Eigen::Vector3d::Zero();
  for (int i = 0; i < 3; ++i) {
    if (to.fix.trusted(i) < kSeen) continue;
    const Eigen::Vector3d axis = to.fix.axes.col(i);
    const double sigma = std::sqrt(axis.dot(covariance * axis) + 2.0 * matching);
    result(i) = std::abs(axis.dot(difference)) / (config_.gate * sigma);
  }
  return result;
}

void Disagreement::blame(const Instant& from, const Instant& to, const Eigen::Vector3d& excess) {
  const double time = to_seconds(to.fix.stamp - from.fix.stamp);
  const bool legs_firm = to.firm - from.firm >= kFirmShare * time;
  lidar_share_.setOnes();
  leg_growth_ = 1.0;
  for (int i = 0; i < 3; ++i) {
    if (streak_(i) < config_.lasting || excess(i) <= 1.0) continue;
    const double growth = std::min(excess(i) * excess(i), config_.most);
    if (legs_firm) {
      lidar_share_(i) = 1.0 / growth;
    } else {
      leg_growth_ = std::max(leg_growth_, growth);
    }
  }
}

void Disagreement::judge(const LidarFix& fix, const Eigen::Matrix3d& leg_drift) {
  carry_streaks_over(fix.axes);
  const double since_last =
      window_.empty() ? 0.0 : to_seconds(fix.stamp - window_.back().fix.stamp);
  now_.fix = fix;
  window_.push_back(now_);
  const Time begin = fix.stamp - from_seconds(config_.window);
  while (window_.size() > 1 && window_[1].fix.stamp <= begin) window_.pop_front();
  const Instant& from = window_.front();
  const bool legs_told = last_leg_ && fix.stamp - last_leg_->stamp <= from_seconds(kLegSilence) &&
                         now_.leg_gap == from.leg_gap;
  if (from.fix.stamp > begin || !legs_told) return;
  const Eigen::Vector3d beyond = excess(from, now_, leg_drift);
  for (int i = 0; i < 3; ++i) {
    if (beyond(i) > 1.0) {
      streak_(i) += since_last;
    } else if (beyond(i) > 0.0) {
      streak_(i) = 0.0;
    }
  }
  blame(from, now_, beyond);
}

}  // namespace aims
