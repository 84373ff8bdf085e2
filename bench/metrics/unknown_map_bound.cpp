// SPDX-License-Identifier: BSD-3-Clause
#include "bench/metrics/unknown_map_bound.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>

#include "bench/metrics/bound_model.hpp"

namespace aims {
namespace {

using bound_model::kSize;
using bound_model::Matrix;
using bound_model::PoseRows;
using Eigen::Vector3d;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// Of a part's pose relative to the body when the part is first seen [m], [rad]: nothing is known,
/// but a Cholesky factor exists.
constexpr double kUnknownSigma = 3.0;
/// Variance of what counts as exactly known.
constexpr double kSmallestVariance = 1e-18;

/// Joint Fisher information of the body's state and of the poses of the parts seen so far: rotation
/// and displacement of the part's centre, in world axes.
class JointInformation {
 public:
  JointInformation(const Matrix& covariance, std::size_t parts)
      : state_((covariance + kSmallestVariance * Matrix::Identity()).inverse()),
        cross_(kSize, static_cast<Eigen::Index>(6 * parts)),
        map_(static_cast<Eigen::Index>(6 * parts), static_cast<Eigen::Index>(6 * parts)),
        slot_(parts, -1) {
    cross_.setZero();
    map_.setZero();
  }

  /// The state becomes F state + noise of covariance Q; parts stay. By the matrix inversion lemma,
  /// so that Q may be singular.
  void predict(const Matrix& F, const Matrix& Q) {
    const Matrix back = F.inverse();
    const Matrix moved = back.transpose() * state_ * back;
    const Matrix keep = (Matrix::Identity() + moved * Q).inverse();
    const Matrix spread = Q * keep;
    auto cross = cross_.leftCols(used_);
    const Eigen::MatrixXd moved_cross = back.transpose() * cross;
    state_ = symmetric(keep * moved);
    cross.noalias() = keep * moved_cross;
    const Eigen::MatrixXd lost = symmetric(spread) * moved_cross;
    map_.topLeftCorner(used_, used_).triangularView<Eigen::Lower>() -=
        moved_cross.transpose() * lost;
  }

  void add(const Matrix& information) { state_ += information; }

  /// Adds what a scan at `T_world_body` measures of a part with that centre.
  void add(const Pose& T_world_body, const PartInformation& seen, const Vector3d& centre) {
    const PoseRows H = bound_model::pose_rows(T_world_body);
    Matrix6 J = seen.information;
    if (seen.part == kKnownPart) return add(H.transpose() * J * H);
    Eigen::Index& slot = slot_[static_cast<std::size_t>(seen.part)];
    if (slot < 0) {
      slot = used_;
      used_ += 6;
      J += Matrix6::Identity() / (kUnknownSigma * kUnknownSigma);
    }
    const Matrix6 G = part_rows(T_world_body, centre);
    state_ += H.transpose() * J * H;
    cross_.middleCols<6>(slot) += H.transpose() * J * G;
    map_.block<6, 6>(slot, slot) += G.transpose() * J * G;
  }

  /// Covariance of the state.
  Matrix covariance() const {
    Eigen::MatrixXd reduced = cross_.leftCols(used_).transpose();
    const Eigen::LLT<Eigen::MatrixXd> factor(map_.topLeftCorner(used_, used_));
    factor.matrixL().solveInPlace(reduced);
    const Matrix information = state_ - reduced.transpose() * reduced;
    return information.ldlt().solve(Matrix::Identity());
  }

 private:
  static Matrix symmetric(const Matrix& m) { return 0.5 * (m + m.transpose()); }

  /// Jacobian of the body's pose relative to the part, in body axes, in the part's pose.
  static Matrix6 part_rows(const Pose& T_world_body, const Vector3d& centre) {
    const Eigen::Matrix3d R_body_world = T_world_body.R().transpose();
    Matrix6 G = Matrix6::Zero();
    G.topLeftCorner<3, 3>() = -R_body_world;
    G.bottomLeftCorner<3, 3>() = R_body_world * hat(T_world_body.translation - centre);
    G.bottomRightCorner<3, 3>() = -R_body_world;
    return G;
  }

  Matrix state_;
  Eigen::MatrixXd cross_;           ///< state by parts
  Eigen::MatrixXd map_;             ///< parts by parts; the lower triangle is valid
  std::vector<Eigen::Index> slot_;  ///< of a part's first row; -1: not seen yet
  Eigen::Index used_ = 0;           ///< rows of the parts seen so far
};

}  // namespace

std::vector<PosteriorBound> unknown_map_bounds(std::span<const TrueMotion> motion,
                                               std::span<const ScanView> views,
                                               std::span<const Vector3d> centres,
                                               const BoundParameters& parameters) {
  std::vector<PosteriorBound> bounds;
  if (motion.empty()) return bounds;
  JointInformation joint(bound_model::initial_covariance(motion.front(), parameters),
                         centres.size());
  TrueMotion at = motion.front();
  const auto step_to = [&](const TrueMotion& next) {
    const double dt = to_seconds(next.stamp - at.stamp);
    if (dt <= 0.0) return;
    joint.predict(bound_model::transition(at, next, dt), bound_model::step_noise(parameters, dt));
    if (parameters.legs.used) joint.add(bound_model::leg_information(next, parameters, dt));
    at = next;
  };
  auto view = std::ranges::find_if(
      views, [&](const ScanView& each) { return each.stamp >= motion.front().stamp; });
  for (const TrueMotion& next : motion) {
    for (; view != views.end() && view->stamp <= next.stamp; ++view) {
      step_to(view->stamp == next.stamp ? next : bound_model::between(at, next, view->stamp));
      for (const PartInformation& seen : view->parts) {
        joint.add(at.T_world_body, seen,
                  seen.part == kKnownPart ? Vector3d(Vector3d::Zero())
                                          : centres[static_cast<std::size_t>(seen.part)]);
      }
      bounds.push_back(bound_model::bound_at(joint.covariance(), at));
    }
    step_to(next);
  }
  return bounds;
}

}  // namespace aims
