// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/lio_sam/imu_odometry.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "estimator/baselines/pose_graph/pose_graph.hpp"

namespace aims::lio_sam {
namespace {

/// Interval of a sample without one before it [s].
constexpr double kFirstInterval = 1.0 / 500.0;

/// Samples kept while no scan is registered.
constexpr std::size_t kMaxSamples = 20000;

double interval(const std::optional<Time>& last, Time stamp) {
  return last ? to_seconds(stamp - *last) : kFirstInterval;
}

void keep(std::deque<ImuSample>& samples, const ImuSample& sample) {
  samples.push_back(sample);
  if (samples.size() > kMaxSamples) samples.pop_front();
}

/// Removes samples before `stamp`; the stamp of the last one removed.
std::optional<Time> drop_before(std::deque<ImuSample>& samples, Time stamp) {
  std::optional<Time> last;
  while (!samples.empty() && samples.front().stamp < stamp) {
    last = samples.front().stamp;
    samples.pop_front();
  }
  return last;
}

Eigen::MatrixXd isotropic(int size, double sigma) {
  return pose_graph::sqrt_information_of_sigmas(Eigen::VectorXd::Constant(size, sigma));
}

Eigen::MatrixXd pose_information(const ImuOdometryConfig& config, bool degenerate) {
  if (degenerate) return isotropic(6, config.degenerate_sigma);
  Eigen::VectorXd sigmas(6);
  sigmas << Eigen::Vector3d::Constant(config.rotation_sigma),
      Eigen::Vector3d::Constant(config.position_sigma);
  return pose_graph::sqrt_information_of_sigmas(sigmas);
}

Eigen::MatrixXd walk_information(const ImuNoiseConfig& noise, double duration) {
  Eigen::VectorXd sigmas(6);
  sigmas << Eigen::Vector3d::Constant(noise.accelerometer_bias),
      Eigen::Vector3d::Constant(noise.gyro_bias);
  return pose_graph::sqrt_information_of_sigmas(std::sqrt(duration) * sigmas);
}

}  // namespace

void describe(Fields& f, ImuOdometryConfig& c) {
  const Range sigma = positive_up_to(1e6);
  f.group("noise", c.noise);
  f.number("gravity", c.gravity, {"m/s^2", in_range(0.1, 100.0), "along -z of the map"});
  f.number("prior_pose_sigma", c.prior_pose_sigma, {"rad, m", sigma, "of the first pose"});
  f.number("prior_velocity_sigma", c.prior_velocity_sigma,
           {"m/s", sigma, "of the first velocity, per axis"});
  f.number("prior_bias_sigma", c.prior_bias_sigma,
           {"m/s^2, rad/s", sigma, "of the first biases, per axis"});
  f.number("rotation_sigma", c.rotation_sigma, {"rad", sigma, "of a LiDAR pose, per axis"});
  f.number("position_sigma", c.position_sigma, {"m", sigma, "of a LiDAR pose, per axis"});
  f.number("degenerate_sigma", c.degenerate_sigma,
           {"rad, m", sigma, "of a LiDAR pose from a degenerate scan, per axis"});
  f.integer("max_keys", c.max_keys,
            {"-", in_range(2, 1000), "keys at which a new graph starts from the last one"});
  f.number("max_speed", c.max_speed,
           {"m/s", positive_up_to(1e6), "a faster estimate is a failure"});
  f.number("max_bias", c.max_bias,
           {"m/s^2, rad/s", positive_up_to(1e6), "a greater bias of either sensor is a failure"});
  f.number(
      "relinearize_threshold", c.relinearize_threshold,
      {"rad, m, m/s, ...", in_range(1e-6, 1e6),
       "greatest entry of a step from which a variable gets a new linearization point", "iSAM2"});
}

ImuOdometry::ImuOdometry(const ImuOdometryConfig& config, const Eigen::Vector3d& p_lidar_imu)
    : config_(config) {
  T_lidar_imu_.translation = p_lidar_imu;
}

std::optional<StampedPose> ImuOdometry::add(const ImuSample& sample) {
  keep(unsolved_, sample);
  keep(newest_, sample);
  if (!solved_) return std::nullopt;
  integrate(newest_motion_, sample.angular_velocity, sample.specific_force,
            interval(last_newest_, sample.stamp), config_.noise);
  last_newest_ = sample.stamp;
  const NavState now = predicted(state_, newest_motion_, bias_, config_.gravity);
  return StampedPose{sample.stamp, now.T_map_imu * T_lidar_imu_.inverse()};
}

void ImuOdometry::correct(const LidarOdometry& scan) {
  if (unsolved_.empty()) return;
  if (!started_) return start(scan);
  if (static_cast<int>(keys_.size()) >= config_.max_keys && !begin_anew()) {
    return fail("odometry.unsolved");
  }
  integrate_until(scan.stamp);
  if (!solve(scan)) return fail("odometry.unsolved");
  if (const char* kind = failure()) return fail(kind);
  integrate_newest(scan.stamp);
  solved_ = true;
}

/// The first key: at rest, without biases. The state from which the next one is predicted stays as
/// it was, as in the published program.
void ImuOdometry::start(const LidarOdometry& scan) {
  if (const auto last = drop_before(unsolved_, scan.stamp)) last_unsolved_ = last;
  const NavState predicted_from = state_;
  state_ = {scan.T_map_lidar * T_lidar_imu_, Eigen::Vector3d::Zero()};
  bias_ = ImuBias();
  begin_graph(isotropic(6, config_.prior_pose_sigma), isotropic(3, config_.prior_velocity_sigma),
              isotropic(6, config_.prior_bias_sigma));
  state_ = predicted_from;
  motion_ = Preintegration();
  started_ = true;
}

/// A graph of one key at the present state.
void ImuOdometry::begin_graph(const Eigen::MatrixXd& pose, const Eigen::MatrixXd& velocity,
                              const Eigen::MatrixXd& bias) {
  graph_.emplace(config_.relinearize_threshold);
  const Key key{graph_->add_variable(state_.T_map_imu), graph_->add_variable(state_.velocity),
                graph_->add_variable(bias_)};
  graph_->add_factor(pose_graph::pose_prior(key.pose, state_.T_map_imu, pose));
  graph_->add_factor(velocity_prior(key.velocity, state_.velocity, velocity));
  graph_->add_factor(bias_prior(key.bias, bias_, bias));
  graph_->update();
  keys_.assign(1, key);
}

/// Starts from the last key with the covariances of its pose, velocity and biases; what they have
/// in common is lost, as in the published program.
bool ImuOdometry::begin_anew() {
  const Key last = keys_.back();
  std::vector<Eigen::MatrixXd> informations;
  for (const int variable : {last.pose, last.velocity, last.bias}) {
    const auto covariance = graph_->marginal_covariance(variable);
    const auto information =
        covariance ? pose_graph::sqrt_information_of(*covariance) : std::nullopt;
    if (!information) return false;
    informations.push_back(*information);
  }
  begin_graph(informations[0], informations[1], informations[2]);
  return true;
}

void ImuOdometry::integrate_until(Time stamp) {
  while (!unsolved_.empty() && unsolved_.front().stamp < stamp) {
    const ImuSample& sample = unsolved_.front();
    integrate(motion_, sample.angular_velocity, sample.specific_force,
              interval(last_unsolved_, sample.stamp), config_.noise);
    last_unsolved_ = sample.stamp;
    unsolved_.pop_front();
  }
}

/// Adds a key and solves twice, since the second time may relinearize.
bool ImuOdometry::solve(const LidarOdometry& scan) {
  const NavState guess = predicted(state_, motion_, bias_, config_.gravity);
  const Key key{graph_->add_variable(guess.T_map_imu), graph_->add_variable(guess.velocity),
                graph_->add_variable(bias_)};
  auto motion = imu_factor(keys_.back(), key, motion_, config_.gravity);
  if (!motion) return false;
  graph_->add_factor(std::move(*motion));
  graph_->add_factor(
      bias_walk(keys_.back().bias, key.bias, walk_information(config_.noise, motion_.duration)));
  graph_->add_factor(pose_graph::pose_prior(key.pose, scan.T_map_lidar * T_lidar_imu_,
                                            pose_information(config_, scan.degenerate)));
  if (!graph_->update() || !graph_->update()) return false;
  keys_.push_back(key);
  state_ = {std::get<Pose>(graph_->estimate(key.pose)),
            std::get<Eigen::Vector3d>(graph_->estimate(key.velocity))};
  bias_ = std::get<ImuBias>(graph_->estimate(key.bias));
  motion_ = Preintegration();
  motion_.bias = bias_;
  return true;
}

const char* ImuOdometry::failure() const {
  if (!(state_.velocity.norm() <= config_.max_speed)) return "odometry.speed";
  const double bias = std::max(bias_.accelerometer.norm(), bias_.gyro.norm());
  return bias <= config_.max_bias ? nullptr : "odometry.bias";
}

/// The next registered scan starts from nothing.
void ImuOdometry::fail(const char* kind) {
  ++failures_[kind];
  const Pose& pose = state_.T_map_imu;
  const bool finite = pose.rotation.coeffs().allFinite() && pose.translation.allFinite() &&
                      state_.velocity.allFinite();
  if (!finite) state_ = NavState();
  started_ = false;
  solved_ = false;
  last_newest_.reset();
}

/// The motion since the registered scan, with its biases.
void ImuOdometry::integrate_newest(Time stamp) {
  std::optional<Time> last = drop_before(newest_, stamp);
  if (newest_.empty()) return;
  newest_motion_ = Preintegration();
  newest_motion_.bias = bias_;
  for (const ImuSample& sample : newest_) {
    integrate(newest_motion_, sample.angular_velocity, sample.specific_force,
              interval(last, sample.stamp), config_.noise);
    last = sample.stamp;
  }
}

}  // namespace aims::lio_sam
