// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/lidar/plane_grid.hpp"

#include <algorithm>
#include <cmath>

namespace aims {
namespace {

/// Quarters with fewer returns have no mean to speak of.
constexpr int kMinQuarter = 3;
/// Largest fraction of the variance across a plane that may lie between the quarters of a cube
/// rather than within them, beyond that of their noise: a step of 1.1 deviations through the middle
/// has it, or quarters that differ by 0.3 in turn. A larger one would hide recesses of a few
/// centimetres, which may be all that a corridor has.
constexpr double kMaxBetween = 0.02;
/// Expected largest of five normal deviations, the thickness of a plane through five points [-].
constexpr double kLargestOfFive = 1.5;
/// Nearest side of a cube that a plane may face, in deviations of its returns.
constexpr double kClearance = 5.0;
/// A plane is fitted again when its returns have grown by this fraction.
constexpr double kGrowth = 0.05;

/// The axis of the cube that a plane faces most.
int facing_axis(const Plane& plane) {
  int axis = 0;
  plane.normal.cwiseAbs().maxCoeff(&axis);
  return axis;
}

/// Whether the side of a cube that faces a plane is so near that returns of the plane lie beyond
/// it. The mean of those within is then on the wrong side, and a scan finds its returns in this
/// cube or the next one by its own error.
bool cut_off(const Plane& plane, double variance, double edge) {
  const double clearance = 0.5 * edge - std::abs(plane.point(facing_axis(plane)));
  return clearance < kClearance * std::sqrt(variance);
}

}  // namespace

void PlaneSums::add(const Eigen::Vector3f& offset) {
  if (count_ >= kMaxCount) return;
  const Eigen::Vector3d d = offset.cast<double>();
  ++count_;
  sum_ += d;
  squares_.noalias() += d * d.transpose();
  Octant& octant = octants_[(offset.x() > 0.0F ? 1U : 0U) + (offset.y() > 0.0F ? 2U : 0U) +
                            (offset.z() > 0.0F ? 4U : 0U)];
  ++octant.count;
  octant.sum += offset;
}

Plane PlaneSums::plane(double edge) const {
  if (count_ < kMinCount) return {};
  const Eigen::Vector3d mean = sum_ / count_;
  PrincipalPlane fit = principal_plane(mean, squares_ / count_ - mean * mean.transpose());
  fit.plane.valid = fit.plane.valid && quarters_agree(fit.plane, fit.variance) &&
                    !cut_off(fit.plane, fit.variance, edge);
  fit.plane.thickness = kLargestOfFive * std::sqrt(fit.variance);
  return fit.plane;
}

/// An analysis of variance: means of groups that share one plane scatter by their noise alone.
bool PlaneSums::quarters_agree(const Plane& plane, double variance) const {
  const std::size_t across = std::size_t{1} << facing_axis(plane);
  double between = 0.0;
  int groups = 0;
  for (std::size_t i = 0; i < octants_.size(); ++i) {
    if ((i & across) != 0) continue;
    const int count = octants_[i].count + octants_[i | across].count;
    if (count < kMinQuarter) continue;
    const Eigen::Vector3f sum = octants_[i].sum + octants_[i | across].sum;
    const double distance = plane.normal.dot(sum.cast<double>() / count - plane.point);
    between += count * distance * distance;
    ++groups;
  }
  // The plane itself takes three of the degrees of freedom; three times the expected noise passes.
  const double noise = 3.0 * std::max(groups - 3, 0) * variance;
  return between - noise <= kMaxBetween * count_ * variance;
}

void PlaneGrid::insert(const Eigen::Vector3f& point, std::size_t half) {
  const VoxelIndex at = voxel_of(point, 1.0F / edge_);
  Cell& cell = cells_.touch(voxel_key(at));
  cell.middle =
      edge_ * Eigen::Vector3f(static_cast<float>(at.x) + 0.5F, static_cast<float>(at.y) + 0.5F,
                              static_cast<float>(at.z) + 0.5F);
  cell.sums[half].add(point - cell.middle);
}

void PlaneGrid::end_insertion() {
  cells_.visit_touched([this](Cell& cell) {
    for (std::size_t half = 0; half < kHalves; ++half) {
      const int count = cell.sums[half].count();
      int& fitted = cell.fitted[half];
      if (count < PlaneSums::kMinCount || count < (1.0 + kGrowth) * fitted) continue;
      fitted = count;
      Plane& plane = half == 0 ? cell.planes.a : cell.planes.b;
      plane = cell.sums[half].plane(edge_);
      plane.point += cell.middle.cast<double>();
    }
  });
}

PlanePair PlaneGrid::planes_at(const Eigen::Vector3f& query) const {
  const Cell* cell = cells_.find(voxel_key(voxel_of(query, 1.0F / edge_)));
  return cell == nullptr ? PlanePair() : cell->planes;
}

void PlaneGrid::limit(std::size_t max_count, const Eigen::Vector3f& center) {
  cells_.limit(max_count, [&center](const Cell& c) { return (c.middle - center).squaredNorm(); });
}

}  // namespace aims
