// SPDX-License-Identifier: BSD-3-Clause
#include "bench/estimate/lidar_odometry.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "estimator/lidar/point_choice.hpp"

namespace aims {
namespace {

constexpr int kMostReturns = 10000;  ///< of a scan that are looked at
constexpr double kNearest = 0.4;     ///< of a return, which is of the robot otherwise [m]
constexpr double kMapVoxel = 0.2;    ///< one point of the map per scan [m]
constexpr double kMatchVoxel = 0.5;  ///< one match per scan [m]
constexpr int kSteps = 15;
constexpr double kFirstScale = 0.5;  ///< of the robust weights in the first step [m]
constexpr double kLastScale = 0.1;   ///< likewise, least one [m]
constexpr double kShrink = 0.6;      ///< of the scale from step to step
constexpr double kSmallStep = 1e-4;  ///< rotation and position [rad, m]
constexpr int kFewestMatches = 30;

// Deviations: of a residual, and of the motion from the one that the scan before predicts.
constexpr double kResidual = 0.1;     ///< noise, map and what residuals of a surface share [m]
constexpr double kRotation = 0.1;     ///< [rad]
constexpr double kPosition = 0.1;     ///< [m]
constexpr double kAngularRate = 0.5;  ///< [rad/s]
constexpr double kVelocity = 0.3;     ///< [m/s]

using Vector12 = Eigen::Matrix<double, 12, 1>;

Vector12 prior_information() {
  Vector12 deviations;
  deviations << Eigen::Vector3d::Constant(kRotation), Eigen::Vector3d::Constant(kPosition),
      Eigen::Vector3d::Constant(kAngularRate), Eigen::Vector3d::Constant(kVelocity);
  return deviations.cwiseAbs2().cwiseInverse();
}

/// The returns that are used, with their times where the scan has any.
std::vector<Eigen::Vector4f> timed_points(const LidarScan& scan, Time middle) {
  const bool timed = std::ranges::any_of(
      scan.points, [](const LidarPoint& each) { return each.time_offset_ns != 0; });
  const int every = 1 + static_cast<int>(scan.points.size()) / kMostReturns;
  std::vector<Eigen::Vector4f> points;
  for (const int index : chosen_points(scan, every, kNearest)) {
    const LidarPoint& each = scan.points[static_cast<std::size_t>(index)];
    const double t = timed ? to_seconds(scan.stamp + each.time_offset_ns - middle) : 0.0;
    points.emplace_back(each.position.x(), each.position.y(), each.position.z(),
                        static_cast<float>(t));
  }
  return points;
}

}  // namespace

/// Of rotation and position of the pose, then of the twist.
struct LidarOdometry::NormalEquations {
  Eigen::Matrix<double, 12, 12> H = Eigen::Matrix<double, 12, 12>::Zero();
  Vector12 b = Vector12::Zero();
  int matches = 0;

  /// A return at `p`, LiDAR axes, fired `t` [s] after the middle.
  void add(const Plane& plane, const Eigen::Vector3d& p, double t, const Pose& pose,
           const Eigen::Matrix3d& R, double scale) {
    const double residual = plane.distance(R * p + pose.translation);
    const Eigen::Vector3d normal = R.transpose() * plane.normal;
    const Eigen::Vector3d turned = p.cross(normal);
    Vector12 J;
    J << turned, plane.normal, t * turned, t * normal;
    const double ratio = residual / scale;
    const double weight = 1.0 / ((1.0 + ratio * ratio) * kResidual * kResidual);
    H.selfadjointView<Eigen::Lower>().rankUpdate(J, weight);
    b -= weight * residual * J;
    ++matches;
  }

  /// The step to the solution, given the motion `predicted`.
  Vector12 solve(const Motion& predicted, const Motion& motion) const {
    static const Vector12 information = prior_information();
    Vector12 off;
    off << so3_log(predicted.pose.rotation.conjugate() * motion.pose.rotation),
        motion.pose.translation - predicted.pose.translation,
        motion.twist.angular - predicted.twist.angular,
        motion.twist.linear - predicted.twist.linear;
    Eigen::Matrix<double, 12, 12> all = H.selfadjointView<Eigen::Lower>();
    all.diagonal() += information;
    return all.ldlt().solve(b - information.cwiseProduct(off));
  }
};

Eigen::Vector3d LidarOdometry::Twist::deskewed(const TimedPoint& point) const {
  const double t = point.w();
  return so3_exp(angular * t) * point.head<3>().cast<double>() + linear * t;
}

LidarOdometry::LidarOdometry() : map_(MapConfig()) { begin_path(); }

void LidarOdometry::begin_path() {
  map_ = VoxelMap(MapConfig());
  twist_ = {};
  if (paths_.empty() || !paths_.back().empty()) paths_.emplace_back();
}

void LidarOdometry::add(const LidarScan& scan) {
  const Time middle = scan.stamp + (scan.end - scan.stamp) / 2;
  const std::vector<TimedPoint> points = timed_points(scan, middle);
  Trajectory& path = paths_.back();
  if (points.empty() || (!path.empty() && middle <= path.back().stamp)) return;
  Motion motion;
  if (!path.empty()) {
    const double dt = to_seconds(middle - path.back().stamp);
    motion = {path.back().pose * Pose{so3_exp(twist_.angular * dt), twist_.linear * dt}, twist_};
    if (!register_points(voxel_centroids(points, kMatchVoxel), motion)) {
      return begin_path();
    }
  } else {
    insert(points, motion);  // the first scan is in both halves, so that the second finds planes
  }
  path.push_back({middle, motion.pose});
  twist_ = motion.twist;
  insert(points, motion);
}

/// Gauss-Newton on distances from planes of the map; `motion` is the prediction and the result.
bool LidarOdometry::register_points(std::span<const TimedPoint> points, Motion& motion) const {
  const Motion predicted = motion;
  double scale = kFirstScale;
  for (int i = 0; i < kSteps; ++i) {
    NormalEquations normal;
    const Eigen::Matrix3d R = motion.pose.R();
    for (const TimedPoint& each : points) {
      const Eigen::Vector3d p = motion.twist.deskewed(each);
      const PlanePair planes = map_.planes_at((motion.pose * p).cast<float>());
      for (const Plane* plane : {&planes.a, &planes.b}) {
        if (plane->valid) normal.add(*plane, p, each.w(), motion.pose, R, scale);
      }
    }
    if (normal.matches < kFewestMatches) return false;
    const Vector12 step = normal.solve(predicted, motion);
    if (!step.allFinite()) return false;
    motion.pose.rotation = (motion.pose.rotation * so3_exp(step.head<3>())).normalized();
    motion.pose.translation += step.segment<3>(3);
    motion.twist.angular += step.segment<3>(6);
    motion.twist.linear += step.tail<3>();
    if (scale <= kLastScale && step.head<6>().cwiseAbs().maxCoeff() < kSmallStep) break;
    scale = std::max(kLastScale, kShrink * scale);
  }
  return true;
}

void LidarOdometry::insert(std::span<const TimedPoint> points, const Motion& motion) {
  std::vector<Eigen::Vector3f> placed;
  for (const TimedPoint& each : points) {
    placed.emplace_back((motion.pose * motion.twist.deskewed(each)).cast<float>());
  }
  map_.insert(voxel_centroids(placed, kMapVoxel), motion.pose.translation.cast<float>());
}

}  // namespace aims
