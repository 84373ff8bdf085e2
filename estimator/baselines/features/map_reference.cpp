// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/features/map_reference.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <cmath>
#include <utility>

namespace aims::features {
namespace {

/// The nearest points of the map, unless the last is too far.
std::optional<FitPoints> neighbors_of(const Eigen::Vector3d& point, const PointIndex& index,
                                      double max_squared_distance) {
  std::array<Neighbor, kFitNeighbors> found;
  if (index.nearest(point.cast<float>(), found) < found.size()) return std::nullopt;
  if (found.back().squared_distance >= max_squared_distance) return std::nullopt;
  FitPoints points;
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i] = index.points()[found[i].index].cast<double>();
  }
  return points;
}

}  // namespace

void describe(Fields& f, MapMatchConfig& c) {
  f.number("max_squared_distance", c.max_squared_distance,
           {"m^2", positive_up_to(1e6), "of the fifth map point"});
  f.number("line_ratio", c.line_ratio,
           {"-", in_range(1.0, 1e6), "least ratio of the two largest eigenvalues of a line"});
  f.number("plane_tolerance", c.plane_tolerance,
           {"m", positive_up_to(1e4), "largest distance of a map point from its plane"});
  f.integer("min_map_edges", c.min_map_edges,
            {"-", in_range(0, 1000000), "the map needs more edge points"});
  f.integer("min_map_planes", c.min_map_planes,
            {"-", in_range(0, 1000000), "the map needs more plane points"});
}

std::optional<LineMatch> fit_line(const FitPoints& points, double ratio) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points) mean += point / kFitNeighbors;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& point : points) {
    covariance += (point - mean) * (point - mean).transpose() / kFitNeighbors;
  }
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(covariance);
  if (!(solver.eigenvalues()[2] > ratio * solver.eigenvalues()[1])) return std::nullopt;
  LineMatch line;
  line.origin = mean;
  line.direction = solver.eigenvectors().col(2);
  return line;
}

std::optional<PlaneMatch> fit_plane_by_intercepts(const FitPoints& points, double tolerance) {
  Eigen::Matrix<double, kFitNeighbors, 3> A;
  for (int i = 0; i < kFitNeighbors; ++i) A.row(i) = points[i].transpose();
  const Eigen::Matrix<double, kFitNeighbors, 1> b =
      Eigen::Matrix<double, kFitNeighbors, 1>::Constant(-1.0);
  const Eigen::Vector3d solution = A.colPivHouseholderQr().solve(b);
  const double norm = solution.norm();
  if (!(norm > 0.0) || !std::isfinite(norm)) return std::nullopt;
  PlaneMatch plane;
  plane.normal = solution / norm;
  plane.offset = 1.0 / norm;
  for (const Eigen::Vector3d& point : points) {
    if (std::abs(plane.normal.dot(point) + plane.offset) > tolerance) return std::nullopt;
  }
  return plane;
}

void MapReference::build(std::vector<Eigen::Vector3f> edges, std::vector<Eigen::Vector3f> planes) {
  edges_.build(std::move(edges));
  planes_.build(std::move(planes));
}

bool MapReference::sufficient(const MapMatchConfig& config) const {
  return static_cast<int>(edges_.points().size()) > config.min_map_edges &&
         static_cast<int>(planes_.points().size()) > config.min_map_planes;
}

FeatureMatches MapReference::match(const FeatureCloud& edges, const FeatureCloud& planes,
                                   const Pose& pose, const MapMatchConfig& config) const {
  FeatureMatches matches;
  const auto neighbors = [&](const FeaturePoint& feature, const PointIndex& index) {
    return neighbors_of(pose * feature.position.cast<double>(), index, config.max_squared_distance);
  };
  for (const FeaturePoint& edge : edges) {
    const auto near = neighbors(edge, edges_);
    auto line = near ? fit_line(*near, config.line_ratio) : std::nullopt;
    if (!line) continue;
    line->point = edge.position.cast<double>();
    matches.lines.push_back(*line);
  }
  for (const FeaturePoint& flat : planes) {
    const auto near = neighbors(flat, planes_);
    auto plane = near ? fit_plane_by_intercepts(*near, config.plane_tolerance) : std::nullopt;
    if (!plane) continue;
    plane->point = flat.position.cast<double>();
    matches.planes.push_back(*plane);
  }
  return matches;
}

}  // namespace aims::features
