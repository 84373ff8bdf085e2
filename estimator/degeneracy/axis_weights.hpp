// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "estimator/degeneracy/noise_information.hpp"
#include "estimator/filter/error_state.hpp"

namespace aims {

/// Three orthogonal axes of position or rotation, and the real fraction of the information along
/// each; derivation in docs/estimators.md.
///
/// The information along an axis is the sum of a real and a noise-induced part, A = A_real +
/// A_noise. The errors of the normals are independent from place to place and add to A, but a shift
/// s of the body appears in the vector through A_real alone: b = A_real s + w, cov(w) = A. With the
/// fraction f = A_real / A the least-squares information about s is A_real A^-1 A_real = f A f and
/// its vector A_real A^-1 b = f b: one factor on each side.
struct AxisWeights {
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< one unit axis per column, odometry frame
  Eigen::Vector3d ratio = Eigen::Vector3d::Zero();     ///< of information to noise
  Eigen::Vector3d probability = Eigen::Vector3d::Ones();  ///< that the information exceeds noise
  /// Acceptance: the probability, or 1 within the bootstrap distance.
  Eigen::Vector3d acceptance = Eigen::Vector3d::Ones();
  Eigen::Vector3d fraction = Eigen::Vector3d::Ones();  ///< of the information beyond noise, [0, 1]

  /// Significant fraction of the information per axis, in [0, 1].
  Eigen::Vector3d significant() const { return probability.cwiseProduct(fraction); }
  /// F = U diag(fraction) U^T: A becomes F A F^T, b becomes F b.
  Eigen::Matrix3d real_fraction() const;
  /// U diag(acceptance) U^T, by which the correction along the axes is multiplied.
  Eigen::Matrix3d gain_factor() const;
};

/// The weights of one block of information `information` (the other block unknown), with the
/// noise-induced information `noise`. The fraction is (ratio - 1) / ratio per axis, cf. Hatleskog
/// and Alexis 2024.
AxisWeights weigh_axes(const Eigen::Matrix3d& information, const Eigen::Matrix3d& noise,
                       const Eigen::Matrix3d& axes, double threshold,
                       const NoiseInformationConfig& config);

/// The principal axes of `information`: `axes` while they diagonalize it to within `tolerance`
/// [rad], otherwise its eigenvectors. Axes that follow the noise of each scan would let strong
/// information leak into the weak axis.
Eigen::Matrix3d persistent_axes(const Eigen::Matrix3d& information, const Eigen::Matrix3d& axes,
                                double tolerance);

/// Removes the noise-induced information of scans, axis by axis, in position and rotation.
class AxisWeigher {
 public:
  explicit AxisWeigher(const NoiseInformationConfig& config) : config_(config) {}

  /// Adds the information A of a scan and its noise-induced part (6x6, at attitude R), `distance`
  /// [m] after the previous scan. Both are averaged over distance, since a standing robot sees the
  /// same noise in every scan. Without distance no information exceeds noise.
  void assess(const Matrix6& A, const Matrix6& noise, const Eigen::Matrix3d& R, double distance);

  /// Real fraction F of the last scan's information, error-state axes at attitude R: the matrix
  /// becomes F A F^T, the vector F b.
  Matrix6 real_fraction(const Eigen::Matrix3d& R) const;

  const AxisWeights& position() const { return position_.weights; }
  const AxisWeights& rotation() const { return rotation_.weights; }

 private:
  struct Block {
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< averaged, odometry frame
    Eigen::Matrix3d noise = Eigen::Matrix3d::Zero();        ///< averaged, odometry frame
    AxisWeights weights;
  };

  void assess(Block& block, const Eigen::Matrix3d& information, const Eigen::Matrix3d& noise,
              double gain);

  NoiseInformationConfig config_;
  double distance_ = 0.0;  ///< since the start [m]
  Block position_;
  Block rotation_;
};

}  // namespace aims
