// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/constrained/x_icp.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace aims {
namespace {

constexpr std::string_view kPackage = "Tuna et al. 2024, published package, ternary detection";

/// Longer moments count as this [m].
constexpr double kLongestMoment = 1.0;

/// A correspondence as one of the two blocks of the Hessian sees it.
struct Row {
  Eigen::Vector3d jacobian;   ///< of the residual in the block
  Eigen::Vector3d alignment;  ///< what its contributions are measured with
  double residual;            ///< [m]
};

std::vector<Row> translation_rows(std::span<const Correspondence> correspondences) {
  std::vector<Row> rows;
  rows.reserve(correspondences.size());
  for (const Correspondence& each : correspondences) {
    rows.push_back({each.normal, each.normal, each.residual});
  }
  return rows;
}

std::vector<Row> rotation_rows(std::span<const Correspondence> correspondences) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Correspondence& each : correspondences) mean += each.point;
  mean /= std::max<double>(1.0, static_cast<double>(correspondences.size()));
  std::vector<Row> rows;
  rows.reserve(correspondences.size());
  for (const Correspondence& each : correspondences) {
    const Eigen::Vector3d moment = (each.point - mean).cross(each.normal_in_body);
    rows.push_back({each.point.cross(each.normal_in_body),
                    moment / std::max(moment.norm() / kLongestMoment, 1.0), each.residual});
  }
  return rows;
}

/// The displacement along `e` of the least squares over the rows that contribute at least `least`.
double sampled_step(const std::vector<Row>& rows, const Eigen::Vector3d& e, double least) {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  Eigen::Vector3d vector = Eigen::Vector3d::Zero();
  for (const Row& row : rows) {
    if (std::abs(row.alignment.dot(e)) < least) continue;
    matrix += row.jacobian * row.jacobian.transpose();
    vector -= row.residual * row.jacobian;
  }
  return e.dot(matrix.completeOrthogonalDecomposition().solve(vector));
}

/// The localizability of the three directions of a block at `offset` of the pose.
void judge(const std::vector<Row>& rows, int offset, const XIcpConfig& config,
           std::span<LocalizedDirection, 3> directions) {
  const double minimal = std::cos(config.minimal_angle_deg * std::numbers::pi / 180.0);
  const double strong = std::cos(config.strong_angle_deg * std::numbers::pi / 180.0);
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();
  for (const Row& row : rows) hessian += row.jacobian * row.jacobian.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(hessian);
  for (int i = 0; i < 3; ++i) {
    LocalizedDirection& it = directions[static_cast<std::size_t>(i)];
    const Eigen::Vector3d e = solver.eigenvectors().col(i);
    it.direction.segment<3>(offset) = e;
    it.eigenvalue = solver.eigenvalues()(i);
    for (const Row& row : rows) {
      const double contribution = std::abs(row.alignment.dot(e));
      if (contribution >= minimal) it.combined += contribution;
      if (contribution >= strong) it.strong += contribution;
    }
    const bool mixed = it.combined >= config.enough_information;
    if (it.combined >= config.high_information || it.strong >= config.enough_information) {
      it.category = LocalizabilityCategory::kFull;
    } else if (mixed || it.strong >= config.insufficient_information) {
      it.category = LocalizabilityCategory::kPartial;
      it.sampled = sampled_step(rows, e, mixed ? minimal : strong);
    }
  }
}

/// The information of the soft constraint of the follow-up (L-Reg): it adds the rows w e^T x = 0 to
/// the equations A x = b, so that along an eigenvector e with eigenvalue l the information l
/// becomes l + w^2 / l. `unit` is the information of one correspondence [1/m^2].
Matrix6 soft_constraints(std::span<const LocalizedDirection> directions, double weight,
                         double unit) {
  Matrix6 damping = Matrix6::Zero();
  for (const LocalizedDirection& each : directions) {
    if (each.category != LocalizabilityCategory::kNone) continue;
    const double information = unit * weight * weight / std::max(each.eigenvalue, 1e-9);
    damping += information * each.direction * each.direction.transpose();
  }
  return damping;
}

}  // namespace

void describe(Fields& f, XIcpConfig& c) {
  const std::string source(kPackage);
  const std::string chosen("docs/baselines/constrained.md#x_icp");
  f.number("minimal_angle_deg", c.minimal_angle_deg,
           {"deg", in_range(0.0, 90.0),
            "correspondences whose normal or moment is farther from a direction do not contribute",
            source});
  f.number("strong_angle_deg", c.strong_angle_deg,
           {"deg", in_range(0.0, 90.0), "nearer to it their contribution is a strong one", source});
  f.number("high_information", c.high_information,
           {"-", up_to(1e9),
            "sum of contributions at which a direction is localizable (published: 300)", chosen});
  f.number(
      "enough_information", c.enough_information,
      {"-", up_to(1e9),
       "sum of strong contributions at which a direction is localizable, and of all at which it "
       "is partially (published: 300)",
       chosen});
  f.number("insufficient_information", c.insufficient_information,
           {"-", up_to(1e9),
            "sum of strong contributions at which a direction is partially localizable "
            "(published: 150)",
            chosen});
  f.number(
      "soft_weight", c.soft_weight,
      {"-", up_to(1e9),
       "weight of soft constraints instead of equalities (L-Reg; published: 440); 0: equalities",
       "Tuna et al. 2024"});
}

std::array<LocalizedDirection, 6> localizability(std::span<const Correspondence> correspondences,
                                                 const XIcpConfig& config) {
  using E = ErrorState;
  std::array<LocalizedDirection, 6> all;
  const std::span<LocalizedDirection, 6> both(all);
  judge(rotation_rows(correspondences), E::kRotation.offset, config, both.first<3>());
  judge(translation_rows(correspondences), E::kPosition.offset, config, both.last<3>());
  return all;
}

PoseConstraints constraints_of(std::span<const LocalizedDirection> directions,
                               const Vector6& offset) {
  PoseConstraints constraints;
  for (const LocalizedDirection& each : directions) {
    if (each.category == LocalizabilityCategory::kFull) continue;
    const bool partial = each.category == LocalizabilityCategory::kPartial;
    const double value = partial ? each.direction.dot(offset) + each.sampled : 0.0;
    constraints.equal.push_back({each.direction, value, partial});
  }
  return constraints;
}

RuledUpdate XIcp::fuse(const Belief& prior, const NominalState& linearization,
                       const Linearization& scan,
                       std::span<const Correspondence> correspondences) const {
  const auto directions = localizability(correspondences, config_);
  const ErrorVector offset = boxminus(linearization, prior.state);
  PoseConstraints constraints = constraints_of(directions, pose_segment(offset));
  if (config_.soft_weight > 0.0) {
    std::erase_if(constraints.equal, [](const PoseConstraint& each) { return !each.measured; });
    const double unit =
        block(scan.measurement.matrix, ErrorState::kPosition, ErrorState::kPosition).trace() /
        std::max<double>(1.0, static_cast<double>(correspondences.size()));
    constraints.damping = soft_constraints(directions, config_.soft_weight, unit);
  }
  ScanVerdict verdict;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const LocalizabilityCategory category = directions[i].category;
    if (category == LocalizabilityCategory::kPartial) verdict.partial = true;
    if (category == LocalizabilityCategory::kNone)
      (i < 3 ? verdict.rotation : verdict.translation) = true;
  }
  return {constrained_step(prior, linearization, scan, constraints), verdict};
}

}  // namespace aims
