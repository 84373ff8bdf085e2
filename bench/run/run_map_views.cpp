// SPDX-License-Identifier: BSD-3-Clause
#include "bench/run/run_map_views.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <limits>
#include <map>
#include <optional>

#include "core/trajectory.hpp"
#include "sim/environment/ray_caster.hpp"
#include "sim/robot/mounts.hpp"
#include "sim/sensors/fisher_information.hpp"
#include "sim/sensors/lidar.hpp"

namespace aims {
namespace {

using Eigen::Vector3d;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr int kFewerFirings = 4;         ///< of the scans that are cast again
constexpr double kMovedOn = 0.4;         ///< a scan is cast again after so far [m] ...
constexpr double kTurnedOn = 0.2;        ///< ... or so much [rad]
constexpr double kNoInformation = 1e-9;  ///< relative to the largest eigenvalue

double flat_distance(const Vector3d& a, const Vector3d& b) { return (a - b).head<2>().norm(); }

/// Points of the path, none nearer than `spacing` to an earlier one.
std::vector<Vector3d> points_along(const Trajectory& path, double spacing) {
  std::vector<Vector3d> points;
  for (const StampedPose& each : path) {
    const Vector3d& p = each.pose.translation;
    if (std::ranges::all_of(points,
                            [&](const Vector3d& q) { return flat_distance(p, q) >= spacing; })) {
      points.push_back(p);
    }
  }
  return points;
}

std::vector<Vector3d> part_centres(const Trajectory& poses, double spacing, std::size_t max_parts) {
  const Trajectory path = thinned(poses, kSecond / 4);
  std::vector<Vector3d> centres = points_along(path, spacing);
  while (centres.size() > std::max<std::size_t>(max_parts, 1)) {
    spacing *= 1.1;
    centres = points_along(path, spacing);
  }
  return centres;
}

int nearest(const std::vector<Vector3d>& centres, const Vector3d& point) {
  const auto best = std::ranges::min_element(
      centres, {}, [&](const Vector3d& each) { return flat_distance(each, point); });
  return static_cast<int>(best - centres.begin());
}

/// The hits by the part of the map that they lie on.
std::map<int, ScanTruth> by_part(const ScanTruth& hits, const std::vector<Vector3d>& centres) {
  std::map<int, ScanTruth> parts;
  for (std::size_t i = 0; i < hits.points.size(); ++i) {
    ScanTruth& part = parts[nearest(centres, hits.points[i].cast<double>())];
    part.points.push_back(hits.points[i]);
    part.normals.push_back(hits.normals[i]);
    part.surfaces.push_back(hits.surfaces[i]);
    part.cosines.push_back(hits.cosines[i]);
    if (!hits.range_sigmas.empty()) part.range_sigmas.push_back(hits.range_sigmas[i]);
  }
  return parts;
}

/// A function of a symmetric matrix without negative eigenvalues.
template <class Function>
Matrix6 of_eigenvalues(const Matrix6& m, const Function& function) {
  const Eigen::SelfAdjointEigenSolver<Matrix6> solver(m);
  const double smallest = kNoInformation * solver.eigenvalues().maxCoeff();
  Eigen::Matrix<double, 6, 1> values;
  for (int i = 0; i < 6; ++i) values[i] = function(solver.eigenvalues()[i], smallest);
  return solver.eigenvectors() * values.asDiagonal() * solver.eigenvectors().transpose();
}

Matrix6 root(const Matrix6& m) {
  return of_eigenvalues(m, [](double value, double) { return std::sqrt(std::max(value, 0.0)); });
}

Matrix6 inverse_root(const Matrix6& m) {
  return of_eigenvalues(m, [](double value, double smallest) {
    return value > smallest ? 1.0 / std::sqrt(value) : 0.0;
  });
}

/// Casts scans again at the true poses of a run.
class Recast {
 public:
  Recast(const SimulationConfig& config, std::uint64_t seed, const Pose& T_body_lidar,
         const Trajectory& poses)
      : config_(with_fewer_firings(config.lidar, kFewerFirings)),
        caster_(build_scene(config.scene, seed)),
        lidar_(config_, caster_, seed),
        T_body_lidar_(T_body_lidar),
        poses_(poses) {}

  /// The information of the scan that ends at `end`, by part.
  std::vector<PartInformation> parts(Time end, const Pose& T_world_body,
                                     const std::vector<Vector3d>& centres) {
    const Time start = end - lidar_.period();
    const auto first = std::ranges::lower_bound(poses_, start, {}, &StampedPose::stamp);
    const auto last = std::ranges::upper_bound(poses_, end, {}, &StampedPose::stamp);
    Trajectory moves(first, last);
    if (moves.empty()) moves.push_back({end, T_world_body});
    for (StampedPose& each : moves) each.pose = each.pose * T_body_lidar_;
    ScanTruth hits;
    lidar_.scan(start, moves, &hits);
    std::vector<PartInformation> parts;
    for (const auto& [part, its_hits] : by_part(hits, centres)) {
      const auto information = scan_information(end, its_hits, T_world_body, config_.range_sigma,
                                                caster_.first_moving_surface());
      if (information.returns > 0) parts.push_back({part, information.information});
    }
    return parts;
  }

 private:
  LidarConfig config_;
  RayCaster caster_;
  Lidar lidar_;
  Pose T_body_lidar_;
  const Trajectory& poses_;
};

/// A scan's information, divided as that of the scan cast again is. What that one misses comes from
/// the part around the robot.
std::vector<PartInformation> divided(const Matrix6& information,
                                     const std::vector<PartInformation>& cast, int around) {
  Matrix6 sum = Matrix6::Zero();
  for (const PartInformation& each : cast) sum += each.information;
  const Matrix6 turn = root(information) * inverse_root(sum);
  Matrix6 rest = information;
  std::vector<PartInformation> parts;
  for (const PartInformation& each : cast) {
    parts.push_back({each.part, turn * each.information * turn.transpose()});
    rest -= parts.back().information;
  }
  const Matrix6 missed =
      of_eigenvalues(rest, [](double value, double) { return std::max(value, 0.0); });
  const auto own = std::ranges::find(parts, around, &PartInformation::part);
  if (own == parts.end()) {
    parts.push_back({around, missed});
  } else {
    own->information += missed;
  }
  return parts;
}

}  // namespace

MapViews map_views(const SimulationConfig& config, const SensorRig& rig, std::uint64_t seed,
                   const Truth& truth, double spacing, std::size_t max_parts) {
  MapViews views;
  const Trajectory poses = body_trajectory(truth);
  if (poses.empty()) return views;
  views.centres = part_centres(poses, spacing, max_parts);
  const Mounts mounts = true_mounts({rig.T_body_base.inverse(), rig.T_body_lidar},
                                    config.calibration, run_seeds(config, seed).robot);
  Recast recast(config, seed, mounts.T_body_lidar, poses);
  std::optional<Pose> last;
  std::vector<PartInformation> cast;
  for (const ScanInformation& scan : truth.scans) {
    const Pose T_world_body =
        pose_at(poses, scan.stamp)
            .value_or(scan.stamp < poses.front().stamp ? poses.front().pose : poses.back().pose);
    const bool moved = !last || (last->translation - T_world_body.translation).norm() > kMovedOn ||
                       last->rotation.angularDistance(T_world_body.rotation) > kTurnedOn;
    if (moved) {
      cast = recast.parts(scan.stamp, T_world_body, views.centres);
      last = T_world_body;
    }
    const int around = nearest(views.centres, T_world_body.translation);
    views.scans.push_back({scan.stamp, divided(scan.information, cast, around)});
  }
  return views;
}

}  // namespace aims
