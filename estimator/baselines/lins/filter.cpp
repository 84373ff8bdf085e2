// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/lins/filter.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace aims::lins {

State plus(const State& x, const ErrorVector& error) {
  State moved = x;
  moved.motion.translation += part(error, Error::kPosition);
  moved.motion.rotation = (x.motion.rotation * so3_exp(part(error, Error::kRotation))).normalized();
  moved.velocity += part(error, Error::kVelocity);
  moved.accelerometer_bias += part(error, Error::kAccelerometerBias);
  moved.gyro_bias += part(error, Error::kGyroBias);
  moved.gravity += part(error, Error::kGravity);
  return moved;
}

ErrorVector minus(const State& to, const State& from) {
  ErrorVector error;
  part(error, Error::kPosition) = to.motion.translation - from.motion.translation;
  part(error, Error::kRotation) = so3_log(from.motion.rotation.conjugate() * to.motion.rotation);
  part(error, Error::kVelocity) = to.velocity - from.velocity;
  part(error, Error::kAccelerometerBias) = to.accelerometer_bias - from.accelerometer_bias;
  part(error, Error::kGyroBias) = to.gyro_bias - from.gyro_bias;
  part(error, Error::kGravity) = to.gravity - from.gravity;
  return error;
}

bool is_finite(const Belief& belief) {
  const State& x = belief.state;
  return x.motion.rotation.coeffs().allFinite() && x.motion.translation.allFinite() &&
         x.velocity.allFinite() && x.accelerometer_bias.allFinite() && x.gyro_bias.allFinite() &&
         x.gravity.allFinite() && belief.covariance.allFinite();
}

Eigen::Quaterniond levelled(const Eigen::Quaterniond& R_world_lidar,
                            const Eigen::Vector3d& gravity) {
  const double sign = gravity.z() >= 0.0 ? 1.0 : -1.0;
  const auto angle = [](double component) {
    return std::asin(std::clamp(component / kGravity, -1.0, 1.0));
  };
  const double pitch = -sign * angle(gravity.x());
  const double roll = sign * angle(gravity.y());
  return yaw_rotation(yaw_of(R_world_lidar)) *
         Eigen::Quaterniond(Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
                            Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()));
}

Belief rebased(const Belief& belief, bool turn_gravity) {
  const Eigen::Matrix3d R_present_last = belief.state.motion.R().transpose();
  Belief next;
  next.state = belief.state;
  next.state.motion = Pose();
  next.state.velocity = R_present_last * belief.state.velocity;
  if (turn_gravity) next.state.gravity = R_present_last * belief.state.gravity;
  next.state.gravity *= kGravity / next.state.gravity.norm();
  const auto keep = [&](int block, const Eigen::Matrix3d& turn) {
    part(next.covariance, block, block) =
        turn * part(belief.covariance, block, block) * turn.transpose();
  };
  keep(Error::kVelocity, R_present_last);
  keep(Error::kAccelerometerBias, Eigen::Matrix3d::Identity());
  keep(Error::kGyroBias, Eigen::Matrix3d::Identity());
  keep(Error::kGravity, R_present_last);
  return next;
}

void describe(Fields& f, ProcessNoise& c) {
  f.number("accelerometer", c.accelerometer,
           {"m/s^2", up_to(1e3), "standard deviation of the specific force"});
  f.number("gyro", c.gyro, {"rad/s", up_to(1e3), "standard deviation of the angular rate"});
  f.number("accelerometer_bias", c.accelerometer_bias,
           {"m/s^3", up_to(1e3), "standard deviation of the change of its bias"});
  f.number("gyro_bias", c.gyro_bias,
           {"rad/s^2", up_to(1e3), "standard deviation of the change of its bias"});
}

State predicted(const State& x, const Inertial& begin, const Inertial& end, double dt) {
  const auto acceleration = [&](const Eigen::Quaterniond& rotation, const Inertial& input) {
    const Eigen::Vector3d force = input.force - x.accelerometer_bias;
    return Eigen::Vector3d(rotation * force + x.gravity);
  };
  const Eigen::Vector3d rate = 0.5 * (begin.rate + end.rate) - x.gyro_bias;
  State next = x;
  next.motion.rotation = (x.motion.rotation * so3_exp(rate * dt)).normalized();
  const Eigen::Vector3d mean =
      0.5 * (acceleration(x.motion.rotation, begin) + acceleration(next.motion.rotation, end));
  next.motion.translation += dt * x.velocity + 0.5 * dt * dt * mean;
  next.velocity += dt * mean;
  return next;
}

ErrorMatrix prediction_jacobian(const State& after, const Inertial& end, double dt) {
  const Eigen::Matrix3d R = after.motion.R();
  ErrorMatrix A = ErrorMatrix::Zero();
  part(A, Error::kPosition, Error::kVelocity).setIdentity();
  part(A, Error::kVelocity, Error::kRotation) = -R * hat(end.force - after.accelerometer_bias);
  part(A, Error::kVelocity, Error::kAccelerometerBias) = -R;
  part(A, Error::kVelocity, Error::kGravity).setIdentity();
  part(A, Error::kRotation, Error::kRotation) = -hat(end.rate - after.gyro_bias);
  part(A, Error::kRotation, Error::kGyroBias) = -Eigen::Matrix3d::Identity();
  return ErrorMatrix::Identity() + A * dt + 0.5 * dt * dt * A * A;
}

ErrorMatrix prediction_noise(double dt, const ProcessNoise& noise) {
  ErrorVector deviations = ErrorVector::Zero();
  part(deviations, Error::kVelocity).setConstant(noise.accelerometer);
  part(deviations, Error::kRotation).setConstant(noise.gyro);
  part(deviations, Error::kAccelerometerBias).setConstant(noise.accelerometer_bias);
  part(deviations, Error::kGyroBias).setConstant(noise.gyro_bias);
  return (dt * deviations).cwiseAbs2().asDiagonal();
}

Belief predicted(const Belief& belief, const Inertial& begin, const Inertial& end, double dt,
                 const ProcessNoise& noise) {
  Belief next;
  next.state = predicted(belief.state, begin, end, dt);
  const ErrorMatrix F = prediction_jacobian(next.state, end, dt);
  const ErrorMatrix covariance = F * belief.covariance * F.transpose();
  next.covariance = 0.5 * (covariance + covariance.transpose()) + prediction_noise(dt, noise);
  return next;
}

namespace {

/// The two blocks that distances depend on, in the order of `Distances`.
constexpr std::array kMeasured = {Error::kPosition, Error::kRotation};

/// K = G H^T / R without the rows of H: G = (I + P H^T H / R)^-1 P.
struct Gain {
  ErrorMatrix information = ErrorMatrix::Zero();  ///< H^T H / R
  ErrorVector pull = ErrorVector::Zero();         ///< H^T d / R
  ErrorMatrix G;

  Gain(const Distances& distances, const ErrorMatrix& prior, double variance) {
    for (int i = 0; i < 2; ++i) {
      part(pull, kMeasured[i]) = distances.Htd.segment<3>(3 * i) / variance;
      for (int j = 0; j < 2; ++j) {
        part(information, kMeasured[i], kMeasured[j]) =
            distances.HtH.block<3, 3>(3 * i, 3 * j) / variance;
      }
    }
    G = (ErrorMatrix::Identity() + prior * information).partialPivLu().solve(prior);
  }

  /// -K (d + H moved) + moved.
  ErrorVector step(const ErrorVector& moved) const {
    return moved - G * (pull + information * moved);
  }

  /// (I - K H) P (I - K H)^T + K R K^T.
  ErrorMatrix covariance(const ErrorMatrix& prior) const {
    const ErrorMatrix rest = ErrorMatrix::Identity() - G * information;
    const ErrorMatrix P = rest * prior * rest.transpose() + G * information * G.transpose();
    return 0.5 * (P + P.transpose());
  }
};

}  // namespace

void describe(Fields& f, UpdateConfig& c) {
  f.number("deviation", c.deviation,
           {"m", in_range(1e-6, 1e3), "standard deviation of a weighted distance"});
  f.integer("max_iterations", c.max_iterations, {"-", in_range(1, 1000), "iterations at most"});
  f.integer("association_interval", c.association_interval,
            {"-", in_range(1, 1000), "iterations for which matches stay, the first unweighted"});
  f.number("weight_slope", c.weight_slope,
           {"1/m", up_to(1e4), "weight = 1 - slope |d|, for planes |d| / sqrt(range)"});
  f.number("min_weight", c.min_weight,
           {"-", in_range(0.0, 0.99), "distances of less weight are left out"});
  f.number("convergence", c.convergence,
           {"-", up_to(1e3), "norm of a step of the error state that ends the update"});
  f.number("divergence_ratio", c.divergence_ratio,
           {"-", positive_up_to(1e6), "growth of the distances' norm that is a divergence"});
}

Vector6 distance_jacobian(const Eigen::Vector3d& point, const Eigen::Vector3d& gradient,
                          const Eigen::Quaterniond& rotation) {
  const Eigen::Vector3d in_scan = rotation.conjugate() * gradient;
  Vector6 jacobian;
  jacobian.head<3>() = gradient;
  jacobian.tail<3>() =
      so3_right_jacobian_inverse(so3_log(rotation)).transpose() * point.cross(in_scan);
  return jacobian;
}

Distances distances_at(const Pose& motion, const features::FeatureMatches& matches,
                       const features::DistanceWeight& weighting) {
  Distances sum;
  sum.lines = static_cast<int>(matches.lines.size());
  sum.planes = static_cast<int>(matches.planes.size());
  features::weighted_distances(
      matches, motion, weighting,
      [&](const Eigen::Vector3d& point, const features::DistanceRow& row, double weight) {
        const Vector6 h = weight * distance_jacobian(point, row.gradient, motion.rotation);
        const double d = weight * row.distance;
        sum.HtH += h * h.transpose();
        sum.Htd += h * d;
        sum.squared_norm += d * d;
        sum.gradients.push_back(row.gradient);
      });
  return sum;
}

Update iterated_update(const Belief& prior, const DistancesAt& distances,
                       const UpdateConfig& config) {
  const double variance = config.deviation * config.deviation;
  Update update;
  update.belief = prior;
  State x = prior.state;
  std::optional<Gain> last_gain;
  double last_norm = std::numeric_limits<double>::infinity();
  while (!update.converged && update.iterations < config.max_iterations) {
    update.last = distances(x, update.iterations);
    const Gain& gain = last_gain.emplace(update.last, prior.covariance, variance);
    const ErrorVector step = gain.step(minus(prior.state, x));
    const double norm = std::sqrt(update.last.squared_norm);
    ++update.iterations;
    if (!step.allFinite() || norm > config.divergence_ratio * last_norm) {
      update.diverged = true;
      return update;
    }
    x = plus(x, step);
    update.converged = step.norm() <= config.convergence;
    last_norm = norm;
  }
  update.belief = {x, last_gain->covariance(prior.covariance)};
  return update;
}

}  // namespace aims::lins
