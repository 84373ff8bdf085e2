// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/degeneracy/cross_validation.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "estimator/filter/pose_information.hpp"

namespace aims {
namespace {

/// Keeps a block without information invertible; far below the information of one return.
constexpr double kRegularization = 1e-9;
/// Keeps a ratio finite where a scan has no information [m^2 over its unit].
constexpr double kTiny = 1e-12;
/// Smaller shifts between scans count as standing [m].
constexpr double kMinShift = 0.05;
/// At the start each scan repeats the same pattern of rings, and the halves share it: real
/// fractions below this are free, and less so over this distance, over which scans come to count.
constexpr double kFreeAtStart = 0.8;
constexpr double kStartDistance = 1.0;  // [m]
/// Distance over which information is averaged: a few times the reach of the neighbours of a plane,
/// so that the noise is seen several times anew [m].
constexpr double kAveragingDistance = 3.0;
/// Distance over which scans share the noise of the map [m]. Measured along plain walls: 0.05 to
/// 0.11 m, integral of the autocorrelation (docs/estimators.md).
constexpr double kNoiseDistance = 0.2;
/// Deviations of its average by which information exceeds zero.
constexpr double kConfidence = 3.0;

/// Information of the averages over that of the present scan, at most, so that the walls of a
/// corridor do not count for long after a bend, along the way of the next one.
constexpr double kMostRemembered = 4.0;

/// What is left of a real fraction when the share `free` of the information is none.
double without(double free, double fraction) {
  return free < 1.0 ? std::clamp((fraction - free) / (1.0 - free), 0.0, 1.0) : 0.0;
}

/// K, 3x3: a position error p is best explained with the rotation error -K p.
Eigen::Matrix3d coupling(const Matrix6& information) {
  const Eigen::Matrix3d rotation =
      information.topLeftCorner<3, 3>() + kRegularization * Eigen::Matrix3d::Identity();
  return rotation.inverse() * information.topRightCorner<3, 3>();
}

}  // namespace

void describe(Fields& f, CrossValidationConfig& c) {
  f.flag("enabled", c.enabled,
         {"", any(), "keep only the information in which both halves of the map agree"});
  f.flag("measure_legs", c.measure_legs,
         {"", any(), "compare legs with scans, which then do not correct along the way",
          "docs/estimators.md#calibration-that-a-robot-keeps"});
}

/// The first scan is used until the robot moves, since all scans of a standing robot have the same
/// noise. Later scans weigh more the farther the robot is from the start, where both halves of the
/// map share the pattern of the rings.
void CrossValidatedInformation::add(const HalvesInformation& scan, const Eigen::Vector3d& position,
                                    std::optional<double> shared_tilt) {
  const bool first = !last_position_;
  const double moved = first ? 0.0 : (position - *last_position_).norm();
  if (!first && moved < kMinShift) return;
  last_position_ = position;
  distance_ += moved;
  const double kept = std::exp(-moved / kAveragingDistance);
  const double added = (1.0 - kept) * (1.0 - std::exp(-distance_ / kStartDistance));
  weight_ = kept * weight_ + added;
  const double gain = first ? 1.0 : added / weight_;
  const Eigen::Matrix3d within = position_information(scan.within);
  const Eigen::Matrix3d across = position_information(scan.across);
  const double weights = scan.within.bottomRightCorner<3, 3>().trace();
  within_ += gain * (within - within_);
  across_ += gain * (across - across_);
  sum_of_weights_ += gain * (weights - sum_of_weights_);
  limit_averages(within);
  const double square = weakest_axis_.dot(across * weakest_axis_) / (weights + kRegularization);
  const double tilt = tilt_of_noise(square, gain);
  update_fraction(shared_tilt.value_or(tilt));
}

/// Adds the `square` of the tilt of a scan's planes towards the weakest axis [rad^2]; the tilt that
/// the noise of the average may pretend, kFreeTilt at first [rad]. An average over the distance L
/// of a scatter that is correlated over l has its deviation times (l / (l + L))^(1/2).
double CrossValidatedInformation::tilt_of_noise(double square, double gain) {
  static const double kOfAverage =
      std::sqrt(kNoiseDistance / (kNoiseDistance + kAveragingDistance));
  constexpr double kLimit = kFreeTilt * kFreeTilt;
  auto& [mean, variance] = squared_tilt_;
  if (gain == 1.0) {  // of one scan nothing is known
    mean = square;
    variance = std::pow(kLimit / (kConfidence * kOfAverage), 2);
  } else {
    const double difference = square - mean;
    mean += gain * difference;
    variance = (1.0 - gain) * (variance + gain * difference * difference);
  }
  return std::sqrt(std::min(kLimit, kConfidence * kOfAverage * std::sqrt(variance)));
}

/// Scales the averages on the axes of their information over that of the scan, both of the position
/// [1/m^2], to `kMostRemembered` where it is more; the fractions of X to W stay on these axes.
void CrossValidatedInformation::limit_averages(const Eigen::Matrix3d& of_scan) {
  const Eigen::Matrix3d scan = of_scan + kRegularization * Eigen::Matrix3d::Identity();
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix3d> solver(within_, scan);
  const Eigen::Array3d ratio = solver.eigenvalues();
  if (ratio(2) <= kMostRemembered) return;
  const Eigen::Array3d scale = (kMostRemembered / ratio.max(kMostRemembered)).sqrt();
  const Eigen::Matrix3d& V = solver.eigenvectors();
  const Eigen::Matrix3d limit = scan * V * scale.matrix().asDiagonal() * V.transpose();
  within_ = (limit * within_ * limit.transpose()).eval();
  across_ = (limit * across_ * limit.transpose()).eval();
}

void CrossValidatedInformation::update_fraction(double free_tilt) {
  // X V = W V diag(f) with V^T W V = I: V diagonalizes C as well, to (1 + f) / 2.
  const Eigen::Matrix3d within = within_ + kRegularization * Eigen::Matrix3d::Identity();
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix3d> solver(across_, within);
  const Eigen::Matrix3d& V = solver.eigenvectors();
  const double at_start = kFreeAtStart * std::exp(-distance_ / kStartDistance);
  Eigen::Array3d fraction;
  Eigen::Array3d step = Eigen::Array3d::Zero();
  constrained_.setIdentity();
  uneven_walls_ = false;
  for (int i = 0; i < 3; ++i) {
    const double f = solver.eigenvalues()(i);
    const double tilt = free_tilt * free_tilt * sum_of_weights_ * V.col(i).squaredNorm();
    const double largest = kFreeTilt * kFreeTilt * sum_of_weights_ * V.col(i).squaredNorm();
    fraction(i) = without(std::max(at_start, tilt), f);
    if (fraction(i) > 0.0 && f < largest) uneven_walls_ = true;
    // What the tilt takes is left out to be safe, and the vector still asks for it; the pattern of
    // the start is no displacement.
    if (fraction(i) > 0.0) step(i) = without(tilt, f) / std::min(f, 1.0);
    const Eigen::Vector3d axis = V.col(i).normalized();
    if (fraction(i) <= 0.0) constrained_ -= axis * axis.transpose();
    if (i == 0) weakest_axis_ = axis;
  }
  weakest_ = fraction.minCoeff();
  const Eigen::Array3d root_of_noise = ((1.0 + fraction) / 2.0).sqrt();
  axes_ = V;
  dual_axes_ = within * V;
  real_ = solver.eigenvalues();
  root_ = fraction / root_of_noise;
  step_gain_ = step * fraction / root_of_noise.square();
}

PoseInformation CrossValidatedInformation::applied_to(const HalvesInformation& scan) const {
  const Eigen::Matrix3d S = position_information(scan.within);
  const Eigen::Vector3d rotation = scan.across_vector.head<3>();
  const Eigen::Vector3d position =
      scan.across_vector.tail<3>() - coupling(scan.across).transpose() * rotation;
  const Eigen::Matrix3d within = axes_.transpose() * S * axes_;
  const Eigen::Matrix3d across = axes_.transpose() * position_information(scan.across) * axes_;
  const Eigen::Array3d of_scan = across.diagonal().array() / (within.diagonal().array() + kTiny);
  const Eigen::Array3d limit = (of_scan > real_).select(real_ / of_scan, 1.0);
  const Eigen::Matrix3d kept = dual_axes_ * root_.matrix().asDiagonal();
  const Eigen::Vector3d gain = (limit * step_gain_).matrix();
  PoseInformation applied{scan.within, scan.across_vector};
  applied.matrix.bottomRightCorner<3, 3>() += kept * within * kept.transpose() - S;
  applied.vector.tail<3>() = coupling(scan.within).transpose() * rotation +
                             dual_axes_ * gain.asDiagonal() * axes_.transpose() * position;
  if (held_by_uneven_walls()) return {scan.within, scan.within_vector, applied.matrix};
  return applied;
}

double weakest_real_fraction(const HalvesInformation& scan) {
  const Eigen::Matrix3d within =
      position_information(scan.within) + kRegularization * Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d across = position_information(scan.across);
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix3d> solver(across, within,
                                                                         Eigen::EigenvaluesOnly);
  return solver.eigenvalues()(0);
}

double weakest_real_tilt(const HalvesInformation& scan) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(position_information(scan.across),
                                                              Eigen::EigenvaluesOnly);
  const double weights = scan.within.bottomRightCorner<3, 3>().trace() + kRegularization;
  const double squared = solver.eigenvalues()(0) / weights;
  return std::copysign(std::sqrt(std::abs(squared)), squared);
}

}  // namespace aims
