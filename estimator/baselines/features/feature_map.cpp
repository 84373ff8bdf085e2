// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/features/feature_map.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <utility>

namespace aims::features {

namespace {

// Cubes around the LiDAR's that are matched, as published.
constexpr std::int64_t kReach = 2;
constexpr std::int64_t kVerticalReach = 1;

void append(const FeatureCloud& cloud, std::vector<Eigen::Vector3f>& points) {
  for (const FeaturePoint& point : cloud) points.push_back(point.position);
}

}  // namespace

/// Cube 0 is centred on the origin.
CubeMap::CubeIndex CubeMap::cube_of(const Eigen::Vector3d& position) const {
  CubeIndex index;
  for (int i = 0; i < 3; ++i) index[i] = std::llround(std::floor(position[i] / cube_size_ + 0.5));
  return index;
}

void CubeMap::insert(const FeatureCloud& points) {
  std::set<CubeIndex> changed;
  for (const FeaturePoint& point : points) {
    const CubeIndex index = cube_of(point.position.cast<double>());
    cubes_[index].push_back(point);
    changed.insert(index);
  }
  for (const CubeIndex& index : changed) {
    FeatureCloud& cube = cubes_[index];
    cube = voxel_centroids(cube, voxel_size_);
  }
}

std::vector<Eigen::Vector3f> CubeMap::around(const Eigen::Vector3d& position) const {
  std::vector<Eigen::Vector3f> points;
  const CubeIndex centre = cube_of(position);
  for (std::int64_t x = -kReach; x <= kReach; ++x) {
    for (std::int64_t y = -kReach; y <= kReach; ++y) {
      for (std::int64_t z = -kVerticalReach; z <= kVerticalReach; ++z) {
        const auto cube = cubes_.find({centre[0] + x, centre[1] + y, centre[2] + z});
        if (cube != cubes_.end()) append(cube->second, points);
      }
    }
  }
  return points;
}

std::vector<Eigen::Vector3f> CubeMap::points() const {
  std::vector<Eigen::Vector3f> points;
  for (const auto& [index, cube] : cubes_) append(cube, points);
  return points;
}

namespace {

using Voxel = std::array<long long, 3>;

Voxel voxel_at(const Eigen::Vector3d& position, double size) {
  Voxel voxel{};
  for (int axis = 0; axis < 3; ++axis) {
    voxel[axis] = std::llround(std::floor(position[axis] / size));
  }
  return voxel;
}

void append(const FeatureCloud& cloud, const Pose& pose, FeatureCloud& points) {
  for (FeaturePoint point : cloud) {
    point.position = (pose * point.position.cast<double>()).cast<float>();
    points.push_back(point);
  }
}

}  // namespace

std::vector<int> KeyframeMap::near(const Eigen::Vector3d& position, double radius,
                                   double voxel) const {
  std::map<Voxel, std::pair<long long, int>> voxels;  // sum of indices, count
  for (int i = 0; i < size(); ++i) {
    const Eigen::Vector3d& p = keyframes_[i].T_map_lidar.translation;
    if ((p - position).norm() > radius) continue;
    auto& [sum, count] = voxels[voxel_at(p, voxel)];
    sum += i;
    ++count;
  }
  std::vector<int> indices;
  for (const auto& [index, mean] : voxels) {
    indices.push_back(static_cast<int>(mean.first / mean.second));
  }
  return indices;
}

int KeyframeMap::nearest(const Eigen::Vector3d& position) const {
  const auto distance = [&](const Keyframe& keyframe) {
    return (keyframe.T_map_lidar.translation - position).squaredNorm();
  };
  const auto found = std::min_element(
      keyframes_.begin(), keyframes_.end(),
      [&](const Keyframe& a, const Keyframe& b) { return distance(a) < distance(b); });
  return static_cast<int>(found - keyframes_.begin());
}

std::vector<int> KeyframeMap::near_means(const Eigen::Vector3d& position, double radius,
                                         double voxel) const {
  std::map<Voxel, std::pair<Eigen::Vector3d, int>> voxels;  // sum of positions, count
  for (const Keyframe& keyframe : keyframes_) {
    const Eigen::Vector3d& p = keyframe.T_map_lidar.translation;
    if ((p - position).norm() > radius) continue;
    auto& [sum, count] =
        voxels.try_emplace(voxel_at(p, voxel), Eigen::Vector3d::Zero(), 0).first->second;
    sum += p;
    ++count;
  }
  std::vector<int> indices;
  for (const auto& [index, mean] : voxels) indices.push_back(nearest(mean.first / mean.second));
  return indices;
}

KeyframeMap::Submap KeyframeMap::submap(const std::vector<int>& indices) const {
  Submap submap;
  for (const int i : indices) {
    append(keyframes_[i].edges, keyframes_[i].T_map_lidar, submap.edges);
    append(keyframes_[i].planes, keyframes_[i].T_map_lidar, submap.planes);
    append(keyframes_[i].outliers, keyframes_[i].T_map_lidar, submap.planes);
  }
  return submap;
}

FeatureCloud KeyframeMap::features(const std::vector<int>& indices) const {
  FeatureCloud cloud;
  for (const int i : indices) append(keyframes_[i].edges, keyframes_[i].T_map_lidar, cloud);
  for (const int i : indices) append(keyframes_[i].planes, keyframes_[i].T_map_lidar, cloud);
  return cloud;
}

std::vector<Eigen::Vector3f> KeyframeMap::points() const {
  std::vector<int> all(keyframes_.size());
  std::iota(all.begin(), all.end(), 0);
  const Submap map = submap(all);
  std::vector<Eigen::Vector3f> points;
  for (const FeaturePoint& point : map.edges) points.push_back(point.position);
  for (const FeaturePoint& point : map.planes) points.push_back(point.position);
  return points;
}

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
