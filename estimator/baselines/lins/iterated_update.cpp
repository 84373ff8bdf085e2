// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/lins/iterated_update.hpp"

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace aims::lins {
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
