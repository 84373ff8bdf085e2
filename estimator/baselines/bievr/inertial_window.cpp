// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/bievr/inertial_window.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <utility>

namespace aims::bievr {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Unknowns of an interval: velocity at its begin and its end, then what all intervals share:
/// biases of accelerometer and gyro, and the tilt of up.
constexpr int kFrom = 0;
constexpr int kTo = 3;
constexpr int kForceBias = 6;
constexpr int kRateBias = 9;
constexpr int kUp = 12;
constexpr int kAll = 14;
constexpr int kLater = kAll - kTo;  ///< without the velocity at the begin

using System = Eigen::Matrix<double, kAll, kAll>;
using Vector = Eigen::Matrix<double, kAll, 1>;
using Later = Eigen::Matrix<double, kLater, kLater>;
using LaterVector = Eigen::Matrix<double, kLater, 1>;

/// A change of the biases makes their first-order correction too coarse beyond this [m/s^2].
constexpr double kReintegrate = 5e-2;

constexpr int kMaxIterations = 5;
constexpr double kConverged = 1e-6;  ///< largest entry of a step

/// Two unit vectors across `up`, as columns.
Eigen::Matrix<double, 3, 2> across(const Vector3d& up) {
  Eigen::Matrix<double, 3, 2> basis;
  basis.col(0) = up.unitOrthogonal();
  basis.col(1) = up.cross(basis.col(0));
  return basis;
}

/// Normal equations J^T J and J^T r of an interval that begins with the velocity `from`.
void linearize(const Interval& interval, const Vector3d& from, const InertialState& x,
               System& normal, Vector& right) {
  const Preintegration& motion = interval.motion;
  const lio_sam::MotionDelta delta = lio_sam::corrected(motion, x.bias);
  const Matrix3d R = interval.from.R().transpose();
  const double dt = motion.duration;
  const Vector3d g = kGravity * x.up;
  const Eigen::Quaterniond turned = interval.from.rotation.conjugate() * interval.to.rotation;
  const Eigen::Quaterniond error = delta.rotation.conjugate() * turned;
  const Vector3d distance = interval.to.translation - interval.from.translation;
  Eigen::Matrix<double, 9, 1> residual;
  residual << so3_log(error), R * (0.5 * dt * dt * g + distance - dt * from) - delta.position,
      R * (dt * g + interval.velocity_to - from) - delta.velocity;
  Eigen::Matrix<double, 9, kAll> J = Eigen::Matrix<double, 9, kAll>::Zero();
  J.block<3, 3>(0, kRateBias) = -error.toRotationMatrix().transpose() * motion.rotation_by_gyro;
  J.block<3, 3>(3, kFrom) = -dt * R;
  J.block<3, 3>(3, kForceBias) = -motion.position_by_accelerometer;
  J.block<3, 3>(3, kRateBias) = -motion.position_by_gyro;
  J.block<3, 2>(3, kUp) = 0.5 * dt * dt * kGravity * R * across(x.up);
  J.block<3, 3>(6, kFrom) = -R;
  J.block<3, 3>(6, kTo) = R;
  J.block<3, 3>(6, kForceBias) = -motion.velocity_by_accelerometer;
  J.block<3, 3>(6, kRateBias) = -motion.velocity_by_gyro;
  J.block<3, 2>(6, kUp) = dt * kGravity * R * across(x.up);
  normal = J.transpose() * J;
  right = J.transpose() * residual;
}

/// A velocity that was eliminated: v = -gain * (what comes later) - offset.
struct Eliminated {
  Eigen::Matrix<double, 3, kLater> gain;
  Vector3d offset;
};

/// Adds what earlier intervals say about the velocity at the begin and what all share.
void add_carried(const Later& carried, const LaterVector& carried_right, System& normal,
                 Vector& right) {
  constexpr int kShared = kAll - kForceBias;
  normal.topLeftCorner<3, 3>() += carried.topLeftCorner<3, 3>();
  normal.topRightCorner<3, kShared>() += carried.topRightCorner<3, kShared>();
  normal.bottomLeftCorner<kShared, 3>() += carried.bottomLeftCorner<kShared, 3>();
  normal.bottomRightCorner<kShared, kShared>() += carried.bottomRightCorner<kShared, kShared>();
  right.head<3>() += carried_right.head<3>();
  right.tail<kShared>() += carried_right.tail<kShared>();
}

Eliminated eliminate(const System& normal, const Vector& right) {
  const Eigen::LDLT<Matrix3d> own(normal.topLeftCorner<3, 3>());
  return {own.solve(normal.topRightCorner<3, kLater>()), own.solve(right.head<3>())};
}

}  // namespace

Preintegration preintegrated(const std::vector<InertialSegment>& segments, const ImuBias& bias) {
  Preintegration motion;
  motion.bias = bias;
  for (const InertialSegment& segment : segments) {
    lio_sam::integrate(motion, segment.angular_velocity, segment.specific_force,
                       to_seconds(segment.end - segment.begin), lio_sam::ImuNoiseConfig());
  }
  return motion;
}

NavState predicted(const NavState& from, const Preintegration& motion, const InertialState& x) {
  const lio_sam::MotionDelta delta = lio_sam::corrected(motion, x.bias);
  const Eigen::Quaterniond& R = from.T_map_imu.rotation;
  const double t = motion.duration;
  const Vector3d g = -kGravity * x.up;
  NavState to;
  to.T_map_imu.rotation = (R * delta.rotation).normalized();
  to.T_map_imu.translation =
      from.T_map_imu.translation + t * from.velocity + 0.5 * t * t * g + R * delta.position;
  to.velocity = from.velocity + t * g + R * delta.velocity;
  return to;
}

void InertialWindow::add(Interval interval, const Vector3d& velocity_from) {
  if (intervals_.empty()) first_velocity_ = velocity_from;
  intervals_.push_back(std::move(interval));
  const Time begin = intervals_.back().end - from_seconds(config_.window);
  while (intervals_.size() > 1 && intervals_.front().segments.front().begin < begin) {
    first_velocity_ = intervals_.front().velocity_to;
    intervals_.pop_front();
  }
}

/// One Gauss-Newton step: velocities are eliminated in order of time, the last one and what all
/// intervals share are solved for, and the others follow backwards. Returns the largest entry.
double InertialWindow::iterate(const Vector3d& prior, InertialState& x) {
  std::vector<Eliminated> eliminated;
  Later carried = Later::Zero();
  LaterVector carried_right = LaterVector::Zero();
  const Vector3d* from = &first_velocity_;
  for (const Interval& interval : intervals_) {
    System normal;
    Vector right;
    linearize(interval, *from, x, normal, right);
    const bool first = from == &first_velocity_;
    if (!first) {
      add_carried(carried, carried_right, normal, right);
      eliminated.push_back(eliminate(normal, right));
    }
    carried = normal.bottomRightCorner<kLater, kLater>();
    carried_right = right.tail<kLater>();
    if (!first) {
      const auto cross = normal.bottomLeftCorner<kLater, 3>();
      carried -= cross * eliminated.back().gain;
      carried_right -= cross * eliminated.back().offset;
    }
    from = &interval.velocity_to;
  }
  const Eigen::Matrix<double, 3, 2> basis = across(x.up);
  const double weight = config_.gravity_weight * config_.gravity_weight;
  carried.bottomRightCorner<2, 2>() += weight * basis.transpose() * basis;
  carried_right.tail<2>() += weight * basis.transpose() * (x.up - prior);
  LaterVector later = carried.ldlt().solve(-carried_right);
  if (!later.allFinite()) return 0.0;
  const double largest = later.cwiseAbs().maxCoeff();
  x.bias.accelerometer += later.segment<3>(kForceBias - kTo);
  x.bias.gyro += later.segment<3>(kRateBias - kTo);
  x.up = (x.up + basis * later.tail<2>()).normalized();
  for (std::size_t i = intervals_.size(); i-- > 0;) {
    intervals_[i].velocity_to += later.head<3>();
    if (i > 0) later.head<3>() = -eliminated[i - 1].gain * later - eliminated[i - 1].offset;
  }
  return largest;
}

bool InertialWindow::solve(InertialState& x) {
  if (intervals_.size() < static_cast<std::size_t>(config_.min_intervals)) return false;
  const Vector3d prior = x.up;
  for (int i = 0; i < kMaxIterations; ++i) {
    for (Interval& each : intervals_) {
      if ((x.bias.accelerometer - each.motion.bias.accelerometer).norm() > kReintegrate) {
        each.motion = preintegrated(each.segments, x.bias);
      }
    }
    if (iterate(prior, x) < kConverged) break;
  }
  return true;
}

}  // namespace aims::bievr
