// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "estimator/aims/directional_config.hpp"
#include "estimator/filter/error_state.hpp"

namespace aims {

/// What the errors of one plane's normal add to A = H^T R^-1 H on average: M C M^T, with M =
/// [hat(p) R^T; I] the derivative of the row in the normal, C the normal's covariance (odometry
/// axes) and p in body axes [m].
Matrix6 chance_information(const Eigen::Matrix3d& normal_covariance, const Eigen::Vector3d& p_body,
                           const Eigen::Matrix3d& R);

/// Information of a block when the other one, with information `other`, is unknown too: the Schur
/// complement of `other`; `cross` is their common block, 3x3 each.
Eigen::Matrix3d schur_complement(const Eigen::Matrix3d& block, const Eigen::Matrix3d& cross,
                                 const Eigen::Matrix3d& other);

/// Ratio to chance at which information is as likely real as not, `way` [m] after the start.
double significant_ratio(const SpuriousConfig& config, double way);

/// Probability that information of `ratio` times what chance gives is more than chance, which is
/// itself known but for a factor (log-normal); one half at the ratio `significant`.
double reality(double ratio, double significant, const SpuriousConfig& config);

/// Three orthogonal axes of position or rotation, and how much of the information along each is
/// kept.
///
/// The information along an axis is that of what is there and of chance, A = A_real + A_chance. A
/// shift of the body by s turns up in the vector as b = A_real s: noise in the normals, which is
/// new from place to place, adds to A and nothing to the mean of b. So A is brought down to A_real
/// and b is left whole, that a scan corrects the whole shift; then both count as far as they are
/// taken.
struct BlockWeights {
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< one unit axis per column, odometry frame
  Eigen::Vector3d ratio = Eigen::Vector3d::Zero();     ///< of information to chance
  Eigen::Vector3d real = Eigen::Vector3d::Ones();      ///< probability of more than chance
  Eigen::Vector3d taken = Eigen::Vector3d::Ones();     ///< for real: `real`, or 1 on trust
  Eigen::Vector3d share = Eigen::Vector3d::Ones();     ///< of the information beyond chance, [0, 1]
  Eigen::Vector3d whole = Eigen::Vector3d::Ones();     ///< part of the vector that counts if taken

  /// What is known to be real of the information, in [0, 1].
  Eigen::Vector3d proven() const { return real.cwiseProduct(share); }
  /// U diag(sqrt(taken share)) U^T on both sides of the information, odometry frame.
  Eigen::Matrix3d shrink() const;
  /// U diag(taken whole) U^T before the vector, odometry frame.
  Eigen::Matrix3d pull() const;
};

/// What is kept of a scan: T A T and P b.
struct KeptOfScan {
  Matrix6 T;
  Matrix6 P;
};

/// The weights of one block whose information, with the other block unknown, is `information`,
/// while `chance` is what normals of noise would give: the share (ratio - 1) / ratio along each
/// axis (cf. Hatleskog and Alexis 2024), taken as far as it is real.
BlockWeights weigh_block(const Eigen::Matrix3d& information, const Eigen::Matrix3d& chance,
                         const Eigen::Matrix3d& axes, double significant,
                         const SpuriousConfig& config);

/// The axes along which `information` splits: `axes` again while they still split it to within
/// `tolerance` [rad], its eigenvectors otherwise. Axes that wobble with the noise would let strong
/// information leak into the weak axis, a little in every scan.
Eigen::Matrix3d steady_axes(const Eigen::Matrix3d& information, const Eigen::Matrix3d& axes,
                            double tolerance);

/// Removes from the information of scans what noisy normals give by chance, axis by axis, in
/// position and in rotation.
class AxisWeigher {
 public:
  explicit AxisWeigher(const SpuriousConfig& config) : config_(config) {}

  /// Takes the information A of a scan and what `chance` adds to it (6x6, at the attitude R), `way`
  /// [m] after the scan before. It is judged over a stretch of way: what a robot sees again and
  /// again while it stands is one draw of chance. Nothing is beyond chance before there is some
  /// way; from there on what is beyond it is taken on trust for `SpuriousConfig::trusting_way`.
  void assess(const Matrix6& A, const Matrix6& chance, const Eigen::Matrix3d& R, double way);

  /// Of the last scan, in the error state's axes at attitude R.
  KeptOfScan kept(const Eigen::Matrix3d& R) const;

  const BlockWeights& position() const { return position_.now; }
  const BlockWeights& rotation() const { return rotation_.now; }

 private:
  struct Block {
    Eigen::Matrix3d smoothed = Eigen::Matrix3d::Zero();  ///< information, odometry frame
    Eigen::Matrix3d smoothed_chance = Eigen::Matrix3d::Zero();
    BlockWeights now;
  };

  void assess(Block& block, const Eigen::Matrix3d& information, const Eigen::Matrix3d& chance,
              double share);

  SpuriousConfig config_;
  double way_ = 0.0;  ///< since the start [m]
  Block position_;
  Block rotation_;
};

}  // namespace aims
