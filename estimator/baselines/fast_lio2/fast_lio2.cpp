// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/fast_lio2/fast_lio2.hpp"

#include <limits>

#include "estimator/baselines/points/translation_constraint.hpp"
#include "estimator/lidar/point_choice.hpp"

namespace aims::fast_lio2 {
namespace {

/// The publication has no index of degeneracy; eigenvalues and localizability are those of the
/// residuals of the last iteration.
std::vector<SeriesInfo> scan_series() {
  return {{"points_in", "-", "points after the voxel filter"},
          {"points_used", "-", "points with an accepted plane in the last iteration"},
          {std::string(kIterationsSeries), "-", "iterations; 0: no update"},
          {"converged", "-", "1: the last iteration made a small step"},
          {"residual_mean", "m", "mean absolute residual before the last step"},
          {"smallest_eigenvalue", "1/m^2", "smallest eigenvalue of the translation information"},
          {"condition_number", "-", "condition number of the translation information"},
          {"localizability", "-", "sum of the cosines between normals and the weakest direction"}};
}

/// `points`: after the voxel filter; `variance`: of a residual [m^2].
ScanRow scan_row(const Update& update, std::size_t points, double variance, Time stamp) {
  const Eigen::VectorXd& distances = update.residuals.distances;
  const points::TranslationConstraint constraint =
      points::translation_constraint(update.residuals.jacobian.middleCols<3>(Error::kPosition));
  const double mean =
      distances.size() > 0 ? distances.cwiseAbs().mean() : std::numeric_limits<double>::quiet_NaN();
  return {stamp,
          points::pose_covariance<Error>(update.belief),
          {static_cast<double>(points), static_cast<double>(distances.size()),
           static_cast<double>(update.iterations), update.converged ? 1.0 : 0.0, mean,
           constraint.smallest / variance, constraint.condition, constraint.localizability}};
}

constexpr double kGravity = 9.81;  ///< of the scaled specific force [m/s^2]

/// Length of the state's gravity: the published program has another constant there [m/s^2].
constexpr double kStateGravity = 9.809;

/// A scan with fewer points is not matched, and does not begin a map.
constexpr std::size_t kMinPoints = 5;

ErrorMatrix start_covariance(const Start& config) {
  ErrorVector variances = ErrorVector::Zero();
  part(variances, Error::kPosition).setConstant(config.pose_variance);
  part(variances, Error::kRotation).setConstant(config.pose_variance);
  part(variances, Error::kMountRotation).setConstant(config.extrinsic_rotation_variance);
  part(variances, Error::kMountTranslation).setConstant(config.extrinsic_translation_variance);
  part(variances, Error::kVelocity).setConstant(config.velocity_variance);
  part(variances, Error::kGyroBias).setConstant(config.gyro_bias_variance);
  part(variances, Error::kAccelerometerBias).setConstant(config.accelerometer_bias_variance);
  variances.segment<2>(Error::kGravity).setConstant(config.gravity_variance);
  return variances.asDiagonal();
}

/// Further from the start the state is of no use, and indices of voxels would overflow [m].
constexpr double kMaxDistance = 1e6;

bool is_usable(const Belief& belief) {
  return is_finite(belief.state) && belief.covariance.allFinite() &&
         belief.state.T_world_body.translation.norm() < kMaxDistance;
}

std::vector<Eigen::Vector3f> in_world(const State& x, const std::vector<Eigen::Vector3f>& points) {
  std::vector<Eigen::Vector3f> moved;
  moved.reserve(points.size());
  for (const Eigen::Vector3f& point : points) moved.push_back(to_world(x, point).cast<float>());
  return moved;
}

}  // namespace

FastLio2::FastLio2(const Config& config, const SensorRig& rig)
    : QueuedEstimator(config.queue, rig, scan_series()),
      config_(config),
      map_(config.map.voxel),
      cube_(config.map) {}

/// Averages the first samples. The frame of the start is the world: gravity is opposite to the mean
/// specific force in it.
bool FastLio2::start(const std::vector<ImuSample>& samples) {
  for (const ImuSample& sample : samples) {
    ++samples_;
    mean_force_ += (sample.specific_force - mean_force_) / samples_;
    mean_rate_ += (sample.angular_velocity - mean_rate_) / samples_;
  }
  if (samples_ < config_.start.min_samples || mean_force_.norm() < 1e-3 * kGravity) return false;
  belief_.state = State();
  belief_.state.T_body_lidar = rig_.T_body_lidar;
  belief_.state.gyro_bias = mean_rate_;
  belief_.state.gravity = -kStateGravity * mean_force_.normalized();
  belief_.covariance = start_covariance(config_.start);
  time_ = samples.back().stamp;
  return true;
}

/// The state at `stamp`, reached by `input`.
Knot FastLio2::knot(const Inertial& input, Time stamp) const {
  const State& x = belief_.state;
  return {stamp, x.T_world_body, x.velocity, input.rate - x.gyro_bias,
          x.T_world_body.rotation * (input.force - x.accelerometer_bias) + x.gravity};
}

void FastLio2::step(const Inertial& input, Time until) {
  if (until <= time_) return;
  belief_ = predicted(belief_, input, to_seconds(until - time_), config_.process_noise);
  time_ = until;
}

/// Steps from sample to sample with the mean of both, then with the last mean to `end`. The
/// specific force is scaled so that the start's mean has the length of gravity.
void FastLio2::predict(const std::vector<ImuSample>& samples, Time begin, Time end) {
  const double scale = kGravity / mean_force_.norm();
  Inertial input;
  knots_.assign(1, knot(input, begin));
  for (const ImuSample& sample : samples) {
    input.rate = 0.5 * (last_sample_->angular_velocity + sample.angular_velocity);
    input.force = 0.5 * scale * (last_sample_->specific_force + sample.specific_force);
    step(input, sample.stamp);
    knots_.push_back(knot(input, sample.stamp));
    last_sample_ = sample;
  }
  step(input, end);
}

void FastLio2::process(const LidarScan& scan) {
  const std::vector<int> indices = selected_points(scan, config_.points);
  const Time end = end_of(scan, indices);
  const std::optional<Time> last = last_sample_ ? std::optional(last_sample_->stamp) : std::nullopt;
  const std::vector<ImuSample> samples = queue_.imu().samples_between(last, end);
  if (samples.empty()) {
    ++result_.counts["lidar.without_imu"];
    return;
  }
  if (!started_) {
    // The published program takes the first scan, with its samples, for the beginning of time.
    if (last_sample_) started_ = start(samples);
    last_sample_ = samples.back();
    return;
  }
  predict(samples, scan.stamp, end);
  if (!is_usable(belief_)) {
    ++result_.counts["filter.rejected"];
    return;
  }
  queue_.imu().forget_before(end - kSecond);
  const std::vector<Eigen::Vector3f> points =
      voxel_centroids(deskewed(scan, indices, knots_, belief_.state), config_.points.voxel);
  const Pose T_world_lidar = belief_.state.T_world_body * belief_.state.T_body_lidar;
  cube_.follow(T_world_lidar.translation, map_);
  if (map_.empty() && points.size() > kMinPoints) {
    for (const Eigen::Vector3f& point : in_world(belief_.state, points)) map_.add(point);
    record({belief_}, points.size(), end);
  } else if (points.size() < kMinPoints) {
    ++result_.counts["lidar.no_update"];
    record({belief_}, points.size(), end);
  } else {
    match(points, end);
  }
}

void FastLio2::match(const std::vector<Eigen::Vector3f>& points, Time stamp) {
  Registration registration(points, map_, config_.residuals, config_.iterations.estimate_extrinsic);
  Update update = iterated_update(
      belief_,
      [&](const State& x, bool search) -> const ScanResiduals& {
        return registration.evaluate(x, search);
      },
      config_.residuals.variance, config_.iterations);
  if (update.iterations == 0) ++result_.counts["lidar.no_update"];
  if (!is_usable(update.belief)) {
    ++result_.counts["filter.rejected"];
    update = {belief_};
  }
  belief_ = update.belief;
  insert_scan(in_world(belief_.state, points), registration.neighbours(), config_.map.voxel, map_);
  record(update, points.size(), stamp);
}

void FastLio2::record(const Update& update, std::size_t points, Time stamp) {
  result_.trajectory.push_back({stamp, belief_.state.T_world_body});
  result_.diagnostics.scans.push_back(scan_row(update, points, config_.residuals.variance, stamp));
}

}  // namespace aims::fast_lio2
