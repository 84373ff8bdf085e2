// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/leg_kilo/leg_kilo.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "estimator/baselines/points/error_blocks.hpp"
#include "estimator/baselines/points/translation_constraint.hpp"

namespace aims::leg_kilo {

namespace {

/// The normals of the planes as rows, each divided by the deviation of its residual if `weighted`.
Eigen::Matrix<double, Eigen::Dynamic, 3> normals_of(const ScanReport& report, double factor,
                                                    bool weighted) {
  Eigen::Matrix<double, Eigen::Dynamic, 3> normals(report.matches.size(), 3);
  for (Eigen::Index i = 0; i < normals.rows(); ++i) {
    const PointOnPlane& match = report.matches[static_cast<std::size_t>(i)];
    const double weight = weighted ? 1.0 / std::sqrt(factor * match.variance) : 1.0;
    normals.row(i) = weight * match.normal.transpose();
  }
  return normals;
}

double mean_distance(const ScanReport& report) {
  double sum = 0.0;
  for (const PointOnPlane& match : report.matches) sum += std::abs(match.distance);
  const auto count = static_cast<double>(report.matches.size());
  return count > 0.0 ? sum / count : std::numeric_limits<double>::quiet_NaN();
}

/// The publication has no index of degeneracy; eigenvalues and localizability are those of the
/// planes of the scan.
std::vector<SeriesInfo> scan_series() {
  return {{"points_in", "-", "points after the voxel filter"},
          {"points_used", "-", "points that lay on a plane"},
          {std::string(kIterationsSeries), "-", "updates by groups of points; 0: none"},
          {"standing_feet", "-", "standing feet per IMU sample"},
          {"residual_mean", "m", "mean absolute distance of points from planes before the updates"},
          {"smallest_eigenvalue", "1/m^2", "smallest eigenvalue of the translation information"},
          {"condition_number", "-", "condition number of the translation information"},
          {"localizability", "-", "sum of the cosines between normals and the weakest direction"}};
}

ScanRow scan_row(const ScanReport& report, const Belief& belief, double variance_factor,
                 Time stamp) {
  const points::TranslationConstraint information =
      points::translation_constraint(normals_of(report, variance_factor, true));
  const points::TranslationConstraint directions =
      points::translation_constraint(normals_of(report, variance_factor, false));
  const double feet = report.imu_samples > 0
                          ? static_cast<double>(report.standing_feet) / report.imu_samples
                          : std::numeric_limits<double>::quiet_NaN();
  return {stamp,
          points::pose_covariance<Error>(belief),
          {static_cast<double>(report.points), static_cast<double>(report.matches.size()),
           static_cast<double>(report.updates), feet, mean_distance(report), information.smallest,
           information.condition, directions.localizability}};
}

constexpr double kGravity = 9.81;  ///< [m/s^2]

/// The points of the map with the covariances that they have at `belief`.
std::vector<MapPoint> map_points_of(const std::vector<Eigen::Vector3d>& points,
                                    const Pose& T_body_lidar, const Belief& belief,
                                    const PointNoise& noise) {
  std::vector<MapPoint> result;
  result.reserve(points.size());
  for (const Eigen::Vector3d& point : points) {
    const ScanPoint at = scan_point(point, T_body_lidar, belief, noise);
    result.push_back({at.in_world, at.covariance});
  }
  return result;
}

}  // namespace

LegKilo::LegKilo(const Config& config, const SensorRig& rig)
    : QueuedEstimator(config.queue, rig, scan_series()),
      config_(config),
      map_(config.map),
      contacts_(config.legs.force_begin, config.legs.force_end) {}

void LegKilo::process_legs(const LegOdometrySample& sample) {
  if (!config_.legs.enabled) return;
  legs_.push_back(sample);
  legs_.back().contact = contacts_.update(sample);
  if (legs_.size() > kMaxHeld) legs_.pop_front();
}

/// The first scan and its samples: their mean is the gyro's bias and opposite to gravity, and the
/// map begins with every return used, before the voxel filter.
bool LegKilo::start(const LidarScan& scan, const std::vector<ImuSample>& samples) {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();
  for (const ImuSample& sample : samples) {
    force += sample.specific_force / static_cast<double>(samples.size());
    rate += sample.angular_velocity / static_cast<double>(samples.size());
  }
  const std::vector<TimedPoint> returns = timed_points(scan, config_.points);
  if (force.norm() < 1e-3 * kGravity || returns.empty()) return false;
  belief_.state = State();
  belief_.state.gravity = -kGravity * force.normalized();
  belief_.state.gyro_bias = rate;
  belief_.covariance = config_.start.variance * ErrorMatrix::Identity();
  force_scale_ = kGravity / force.norm();
  predicted_ = updated_ = last_firing(scan);
  std::vector<Eigen::Vector3d> points;
  for (const TimedPoint& each : returns) points.push_back(each.head<3>().cast<double>());
  map_.build(map_points_of(points, rig_.T_body_lidar, belief_, config_.point_noise));
  return true;
}

void LegKilo::process(const LidarScan& scan) {
  const Time end = last_firing(scan);
  const std::vector<ImuSample> samples = queue_.imu().samples_between(last_sample_, end);
  if (samples.empty()) {
    ++result_.counts["lidar.without_imu"];
    return;
  }
  last_sample_ = samples.back().stamp;
  queue_.imu().forget_before(end - kSecond);
  ScanReport report;
  if (!started_) {
    started_ = start(scan, samples);
    if (started_) record(report, end);
    return;
  }
  const Belief before = belief_;
  if (!register_scan(scan, samples, report)) {
    belief_ = before;
    ++result_.counts["filter.rejected"];
    return;
  }
  if (report.updates == 0) ++result_.counts["lidar.no_update"];
  map_.limit(belief_.state.T_world_body.translation);
  record(report, end);
}

/// IMU samples and groups of points in order of time; false when the state runs away. As published,
/// samples after the last group are dropped.
bool LegKilo::register_scan(const LidarScan& scan, const std::vector<ImuSample>& samples,
                            ScanReport& report) {
  auto next = samples.begin();
  for (const PointGroup& group : point_groups(scan, config_.points)) {
    for (; next != samples.end() && next->stamp < group.stamp; ++next) observe(*next, report);
    predict(group.stamp);
    if (!is_usable(belief_)) return false;
    register_group(group, report);
  }
  return is_usable(belief_);
}

/// As published, the covariance is predicted from the last update, so again over the time of a
/// prediction that no update followed.
void LegKilo::predict(Time stamp) {
  belief_.covariance = predicted_covariance(belief_.covariance, belief_.state,
                                            to_seconds(stamp - updated_), config_.process_noise);
  belief_.state = predicted(belief_.state, to_seconds(stamp - predicted_));
  predicted_ = stamp;
}

void LegKilo::observe(const ImuSample& sample, ScanReport& report) {
  predict(sample.stamp);
  const std::vector<StandingFoot> feet = feet_at(sample.stamp);
  const Inertial reading{force_scale_ * sample.specific_force, sample.angular_velocity};
  belief_ = updated(belief_, inertial_observation(belief_.state, reading, feet, config_.imu,
                                                  config_.legs.variance));
  updated_ = sample.stamp;
  ++report.imu_samples;
  report.standing_feet += static_cast<int>(feet.size());
}

/// The feet that stand by the newest leg data not after `stamp`.
std::vector<StandingFoot> LegKilo::feet_at(Time stamp) {
  while (legs_.size() > 1 && legs_[1].stamp <= stamp) legs_.pop_front();
  if (legs_.empty()) return {};
  const LegOdometrySample& sample = legs_.front();
  const bool fresh =
      sample.stamp <= stamp && to_seconds(stamp - sample.stamp) < config_.legs.max_age;
  if (!fresh) return {};
  const bool by_joints = config_.legs.feet == FeetFrom::kContacts && has_joints(sample, rig_);
  return by_joints ? feet_in_contact(sample, rig_) : feet_of_twist(sample, rig_);
}

/// Corrects the state with the points that lie on a plane, then adds all of them to the map.
void LegKilo::register_group(const PointGroup& group, ScanReport& report) {
  std::vector<PointOnPlane> matches;
  for (const Eigen::Vector3d& point : group.points) {
    const ScanPoint at = scan_point(point, rig_.T_body_lidar, belief_, config_.point_noise);
    if (const auto match = map_.match(at, config_.residuals)) matches.push_back(*match);
  }
  report.points += static_cast<int>(group.points.size());
  if (!matches.empty()) {
    belief_ = updated(belief_,
                      point_observation(belief_.state, matches, config_.residuals.variance_factor));
    updated_ = group.stamp;
    ++report.updates;
    report.matches.insert(report.matches.end(), matches.begin(), matches.end());
  }
  if (!is_usable(belief_)) return;
  map_.add(map_points_of(group.points, rig_.T_body_lidar, belief_, config_.point_noise));
}

void LegKilo::record(const ScanReport& report, Time stamp) {
  result_.trajectory.push_back({stamp, belief_.state.T_world_body});
  result_.diagnostics.scans.push_back(
      scan_row(report, belief_, config_.residuals.variance_factor, stamp));
}

}  // namespace aims::leg_kilo
