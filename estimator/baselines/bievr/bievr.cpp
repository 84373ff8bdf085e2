// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/bievr/bievr.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <limits>

#include "core/measurements.hpp"
#include "estimator/filter/pose_information.hpp"

namespace aims::bievr {
namespace {

/// The returns of a scan that are near enough, in body axes.
struct TimedPoints {
  std::vector<Eigen::Vector3d> points;  ///< each at its own firing [m]
  std::vector<Time> stamps;             ///< of the firings
};

struct Knot {
  Time stamp = 0;
  Pose T_world_body;
};

/// Poses at the begin and at the end of each segment.
std::vector<Knot> knots_of(const NavState& from, const std::vector<InertialSegment>& segments,
                           const InertialState& x) {
  std::vector<Knot> knots = {{segments.front().begin, from.T_map_imu}};
  Preintegration motion;
  motion.bias = x.bias;
  for (const InertialSegment& segment : segments) {
    lio_sam::integrate(motion, segment.angular_velocity, segment.specific_force,
                       to_seconds(segment.end - segment.begin), lio_sam::ImuNoiseConfig());
    knots.push_back({segment.end, predicted(from, motion, x).T_map_imu});
  }
  return knots;
}

Pose pose_at(const std::vector<Knot>& knots, Time stamp) {
  const auto after = std::ranges::lower_bound(knots, stamp, {}, &Knot::stamp);
  if (after == knots.begin()) return knots.front().T_world_body;
  if (after == knots.end()) return knots.back().T_world_body;
  const Knot& before = *std::prev(after);
  const double fraction =
      to_seconds(stamp - before.stamp) / to_seconds(after->stamp - before.stamp);
  return interpolate(before.T_world_body, after->T_world_body, fraction);
}

TimedPoints points_in_range(const LidarScan& scan, const Pose& T_body_lidar, const Points& config) {
  const Eigen::Matrix3d R = T_body_lidar.R();
  TimedPoints result;
  result.points.reserve(scan.points.size());
  result.stamps.reserve(scan.points.size());
  for (const LidarPoint& point : scan.points) {
    const auto range = static_cast<double>(point.position.norm());
    if (!(range >= config.min_range && range <= config.max_range)) continue;
    result.points.emplace_back(R * point.position.cast<double>() + T_body_lidar.translation);
    result.stamps.push_back(scan.stamp + point.time_offset_ns);
  }
  return result;
}

/// The points in body axes at the end of `segments`. `from`: at their begin. Poses between the ends
/// of segments are interpolated; a point outside of the segments keeps the pose of their begin or
/// end.
std::vector<Eigen::Vector3d> deskewed(const TimedPoints& scan, const NavState& from,
                                      const std::vector<InertialSegment>& segments,
                                      const InertialState& x) {
  if (segments.empty()) return scan.points;
  const std::vector<Knot> knots = knots_of(from, segments, x);
  const Pose T_end_world = knots.back().T_world_body.inverse();
  std::vector<Eigen::Vector3d> points;
  points.reserve(scan.points.size());
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Vector3d t = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    if (i == 0 || scan.stamps[i] != scan.stamps[i - 1]) {  // the rings of a column fire together
      const Pose T_end_now = T_end_world * pose_at(knots, scan.stamps[i]);
      R = T_end_now.R();
      t = T_end_now.translation;
    }
    points.emplace_back(R * scan.points[i] + t);
  }
  return points;
}

/// A map of fewer voxels is extended by predicted scans.
constexpr std::size_t kMinVoxels = 6;

/// Further from the start indices of voxels would overflow [m].
constexpr double kMaxDistance = 1e5;

bool is_usable(const Pose& pose) {
  return pose.translation.allFinite() && pose.rotation.coeffs().allFinite() &&
         pose.translation.norm() < kMaxDistance;
}

std::vector<SeriesInfo> scan_series() {
  return {{"points_in", "-", "points chosen for registration"},
          {"points_fine", "-", "of them in voxels of much relief"},
          {"points_used", "-", "points with a surface at the last linearization"},
          {std::string(kIterationsSeries), "-", "steps; 0: no registration"},
          {"converged", "-", "1: the last step was small"},
          {"residual_mean", "m", "mean absolute residual before the last step"},
          {"smallest_eigenvalue", "-",
           "smallest eigenvalue of the position's Hessian, in points that face it"},
          {"condition_number", "-", "condition number of that Hessian"}};
}

}  // namespace

Bievr::Bievr(const Config& config, const SensorRig& rig)
    : QueuedEstimator(config.queue, rig, scan_series()),
      config_(config),
      map_(config.map),
      window_(config.inertial) {}

/// Takes the mean specific force for vertical and what exceeds gravity for bias.
bool Bievr::start(Time end) {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();
  int count = 0;
  Time last = 0;
  for (const ImuSample& sample : queue_.imu().samples()) {
    if (sample.stamp > end) continue;
    if (!first_sample_) first_sample_ = sample.stamp;
    force += sample.specific_force;
    rate += sample.angular_velocity;
    last = sample.stamp;
    ++count;
  }
  if (count == 0 || to_seconds(last - *first_sample_) <= config_.inertial.start) return false;
  force /= count;
  const Eigen::Vector3d gravity = kGravity * force.normalized();
  inertial_.bias = {force - gravity, rate / count};
  state_.T_map_imu.rotation = Eigen::Quaterniond::FromTwoVectors(gravity, Eigen::Vector3d::UnitZ());
  return true;
}

void Bievr::process(const LidarScan& scan) {
  if (started_) return follow(scan);
  if (!start(scan.end)) return;
  started_ = true;
  time_ = scan.end;
  map(points_in_range(scan, rig_.T_body_lidar, config_.points).points);
  record({}, {.T_world_body = state_.T_map_imu, .last = {}});
}

/// A scan after the start: prediction, deskewing, sampling, registration, map, biases.
void Bievr::follow(const LidarScan& scan) {
  if (scan.end <= time_) return;
  queue_.imu().segments(time_, scan.end, segments_);
  if (segments_.empty()) {
    ++result_.counts["lidar.without_imu"];
    return;
  }
  const Preintegration motion = preintegrated(segments_, inertial_.bias);
  const NavState prediction = predicted(state_, motion, inertial_);
  const std::vector<Eigen::Vector3d> points = deskewed(
      points_in_range(scan, rig_.T_body_lidar, config_.points), state_, segments_, inertial_);
  Sample sample;
  sample.points = thinned(points, config_.points.voxel);
  if (config_.points.informed_sampling) {
    sample = informed_sample(sample.points, map_, prediction.T_map_imu,
                             static_cast<std::size_t>(config_.points.informed_voxels));
  }
  const Registered registered = match(sample, prediction);
  time_ = scan.end;
  if (!is_usable(registered.T_world_body)) return restart();
  const NavState from = state_;
  state_ = {registered.T_world_body, prediction.velocity};
  map(points);
  learn(prediction, motion, from);
  record(sample, registered);
  queue_.imu().forget_before(time_ - kSecond);
}

/// The registered scan, or the prediction where it cannot be registered.
Registered Bievr::match(const Sample& sample, const NavState& prediction) {
  Registered result;
  result.T_world_body = prediction.T_map_imu;
  if (map_.size() >= kMinVoxels) {
    result = registered(map_, prediction.T_map_imu, sample.points, config_.registration);
  }
  if (result.iterations == 0) ++result_.counts["lidar.no_update"];
  return result;
}

/// Stands where it was, without biases: neither the prediction nor a registration is of any use.
void Bievr::restart() {
  ++result_.counts["filter.rejected"];
  state_.velocity.setZero();
  inertial_.bias = {};
  window_.clear();
  record({}, {.T_world_body = state_.T_map_imu, .last = {}});
}

void Bievr::map(const std::vector<Eigen::Vector3d>& points) {
  const Eigen::Matrix3d R = state_.T_map_imu.R();
  std::vector<MapPoint> placed;
  placed.reserve(points.size());
  for (const Eigen::Vector3d& point : points) {
    placed.push_back({R * point + state_.T_map_imu.translation, point.norm()});
  }
  map_.insert(placed);
}

/// Velocity, biases and gravity from the registered poses.
void Bievr::learn(const NavState& prediction, const Preintegration& motion, const NavState& from) {
  if (map_.size() <= static_cast<std::size_t>(config_.inertial.min_voxels)) return;
  window_.add({time_, from.T_map_imu, state_.T_map_imu, prediction.velocity, segments_, motion},
              from.velocity);
  if (window_.solve(inertial_)) state_.velocity = window_.velocity();
}

void Bievr::record(const Sample& sample, const Registered& registered) {
  const LinearCost& last = registered.last;
  const Eigen::Vector3d eigenvalues =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(position_information(last.hessian),
                                                     Eigen::EigenvaluesOnly)
          .eigenvalues();
  const double none = std::numeric_limits<double>::quiet_NaN();
  result_.trajectory.push_back({time_, state_.T_map_imu});
  result_.diagnostics.scans.push_back(
      {time_,
       std::nullopt,
       {static_cast<double>(sample.points.size()), static_cast<double>(sample.fine),
        static_cast<double>(last.used), static_cast<double>(registered.iterations),
        registered.converged ? 1.0 : 0.0, last.used > 0 ? last.absolute / last.used : none,
        last.used > 0 ? std::max(eigenvalues(0), 0.0) : none,
        last.used > 0 ? eigenvalues(2) / std::max(eigenvalues(0), 1e-9) : none}});
}

}  // namespace aims::bievr
