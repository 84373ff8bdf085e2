// SPDX-License-Identifier: BSD-3-Clause
#include "lab/weak/weak_direction.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "bench/jobs/sequence_cache.hpp"
#include "bench/metrics/localizability.hpp"
#include "bench/metrics/statistics.hpp"
#include "bench/scenario/scenario_draws.hpp"
#include "core/trajectory.hpp"
#include "sim/sensors/fisher_information.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;

constexpr double kSpacing = 1.0;  ///< between scans that are cast again, and of the legs' error [m]

/// The information of a scan about the position along the weak axis [1/m^2].
struct AlongWeakAxis {
  double planes = 0.0;
  double relief = 0.0;
  double intensity = 0.0;
  double variance = 0.0;  ///< of a range [m^2]
};

/// A scene in which scans are cast again at the true poses.
class Scans {
 public:
  Scans(const LidarConfig& config, const Scene& scene, std::uint64_t seed)
      : config_(config), caster_(scene), lidar_(config, caster_, seed) {}

  /// Casts the scan that ends at `end`; `poses` are those of the body.
  void cast(Time end, const Trajectory& poses, const Pose& T_body_lidar) {
    const Time start = end - lidar_.period();
    Trajectory moves;
    const auto first = std::ranges::lower_bound(poses, start, {}, &StampedPose::stamp);
    for (auto each = first; each != poses.end() && each->stamp <= end; ++each) {
      moves.push_back({each->stamp, each->pose * T_body_lidar});
    }
    scan_ = lidar_.scan(start, moves, &hits_);
  }
  ScanInformation ranges(Time end, const Pose& T_world_body) const {
    return scan_information(end, hits_, T_world_body, config_.range_sigma,
                            caster_.first_moving_surface());
  }
  ScanInformation intensities(Time end, const Pose& T_world_body, const Pose& T_body_lidar) const {
    const ScanTruth rows =
        intensity_rows(caster_, config_, scan_, hits_, T_world_body * T_body_lidar.translation);
    return scan_information(end, rows, T_world_body, 1.0, caster_.first_moving_surface());
  }

 private:
  LidarConfig config_;
  RayCaster caster_;
  Lidar lidar_;
  LidarScan scan_;
  ScanTruth hits_;
};

double along(const BlockInformation& information, const Vector3d& axis) {
  const Vector3d parts = information.axes.transpose() * axis;
  return parts.cwiseAbs2().dot(information.eigenvalues);
}

/// Every source of the scan that ends at `end`, added to those before.
AlongWeakAxis sources_of(Time end, const Pose& T_world_body, const Trajectory& poses,
                         const Pose& T_body_lidar, Scans& plain, Scans& real) {
  plain.cast(end, poses, T_body_lidar);
  real.cast(end, poses, T_body_lidar);
  const BlockInformation planes =
      translation_information(plain.ranges(end, T_world_body).information);
  const Vector3d axis = planes.weak_axis();
  const ScanInformation ranges = real.ranges(end, T_world_body);
  const ScanInformation intensities = real.intensities(end, T_world_body, T_body_lidar);
  const double walls = along(translation_information(ranges.information), axis);
  const double both =
      along(translation_information(ranges.information + intensities.information), axis);
  return {planes.eigenvalues(0), walls - planes.eigenvalues(0), both - walls,
          ranges.range_sigma * ranges.range_sigma};
}

std::vector<AlongWeakAxis> sources_of(const Sequence& sequence, const SimulationConfig& config,
                                      std::uint64_t seed) {
  const Truth& truth = sequence.reader.truth();
  const Trajectory& poses = sequence.truth_trajectory;
  Scene scene = build_scene(config.scene, seed);
  Scans real(config.lidar, scene, seed);
  scene.surface = {};
  Scans plain(config.lidar, scene, seed);
  std::vector<AlongWeakAxis> sources;
  std::optional<Vector3d> last;
  for (const ScanInformation& scan : truth.scans) {
    const auto pose = pose_at(poses, scan.stamp);
    if (!pose || scan.stamp - poses.front().stamp < scan_period(config.lidar)) continue;
    if (last && (pose->translation - *last).norm() < kSpacing) continue;
    last = pose->translation;
    sources.push_back(sources_of(scan.stamp, *pose, poses, truth.mounts.T_body_lidar, plain, real));
  }
  return sources;
}

template <class Value>
double median_of(const std::vector<AlongWeakAxis>& sources, const Value& value) {
  std::vector<double> values;
  for (const AlongWeakAxis& each : sources) values.push_back(value(each));
  return median(values).value_or(0.0);
}

/// Mean square of the error of the distance over the last metre [m^2].
double leg_variance(const Trajectory& estimate, const Trajectory& truth) {
  double sum = 0.0;
  int count = 0;
  std::optional<StampedPose> last;
  std::optional<Pose> last_truth;
  for (const StampedPose& each : estimate) {
    const auto at = pose_at(truth, each.stamp);
    if (!at) continue;
    if (last) {
      const double walked = (at->translation - last_truth->translation).head<2>().norm();
      if (walked < kSpacing) continue;
      const double told = (each.pose.translation - last->pose.translation).head<2>().norm();
      sum += std::pow((told - walked) / walked * kSpacing, 2);
      ++count;
    }
    last = each;
    last_truth = at;
  }
  return count > 0 ? sum / count : 0.0;
}

/// Median over the scans that corrected the estimate [1/m^2].
double believed_by(const Diagnostics& diagnostics) {
  std::vector<double> values;
  for (std::size_t i = 0; i < diagnostics.scans.size(); ++i) {
    const double value = diagnostics.value(i, "weak_information");
    if (diagnostics.updated(i) && std::isfinite(value)) values.push_back(value);
  }
  return median(values).value_or(0.0);
}

Result<Sequence> sequence_of(const Scenario& scenario, std::uint64_t seed, const fs::path& folder,
                             const PartObserver& observer) {
  const SequenceCache cache(folder.empty() ? SequenceCache::default_folder() : folder);
  const auto made = cache.make(scenario, seed, observer);
  if (!made) return tl::unexpected(made.error());
  if (made->refusal) {
    return failure(fmt::format("{} seed {}: {}", scenario.name, seed, *made->refusal));
  }
  return open_sequence(cache.file_of(SequenceCache::id_of(scenario, seed)), scenario, seed);
}

}  // namespace

Result<WeakDirection> weak_direction(const Scenario& scenario, std::uint64_t seed,
                                     const fs::path& cache, const PartObserver& observer) {
  const Scenario drawn = scenario_of_seed(scenario, seed);
  const auto sequence = sequence_of(drawn, seed, cache, observer);
  if (!sequence) return tl::unexpected(sequence.error());
  const auto legs = evaluate(*sequence, drawn, "leg_inertial", observer);
  if (!legs) return tl::unexpected(legs.error());
  const auto filter = evaluate(*sequence, drawn, "aims_d", observer);
  if (!filter) return tl::unexpected(filter.error());
  const auto sources = sources_of(*sequence, drawn.simulation, seed);
  const double variance = median_of(sources, [](const auto& each) { return each.variance; });
  const double of_legs = leg_variance(legs->result.trajectory, sequence->truth_trajectory);
  WeakDirection result;
  result.scenario = scenario.name;
  result.seed = seed;
  result.range_sigma = std::sqrt(variance);
  result.planes = median_of(sources, [](const auto& each) { return each.planes * each.variance; });
  result.relief = median_of(sources, [](const auto& each) { return each.relief * each.variance; });
  result.intensity =
      median_of(sources, [](const auto& each) { return each.intensity * each.variance; });
  result.legs = of_legs > 0.0 ? variance / of_legs : 0.0;
  result.believed = believed_by(filter->result.diagnostics) * variance;
  return result;
}

}  // namespace aims
