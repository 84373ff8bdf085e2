// SPDX-License-Identifier: BSD-3-Clause
#include "sim/sensors/lidar.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <utility>

#include "core/angle.hpp"
#include "sim/environment/people.hpp"
#include "sim/sensors/pose_cursor.hpp"

namespace aims {

namespace {

BeamAngles true_angles(const LidarCalibration& calibration, int ring, const BeamAngles& nominal) {
  return {nominal.azimuth + calibration.azimuth_cosine * std::cos(nominal.azimuth) +
              calibration.azimuth_sine * std::sin(nominal.azimuth),
          nominal.elevation + calibration.ring_elevation[static_cast<std::size_t>(ring)]};
}

/// Whether a beam from the origin enters the body mask.
bool enters_body_mask(const LidarConfig& config, const Eigen::Vector3d& direction) {
  if ((config.body_mask_max.array() <= config.body_mask_min.array()).any()) return false;
  double enter = 0.0;
  double leave = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const double low = config.body_mask_min[axis] / direction[axis];
    const double high = config.body_mask_max[axis] / direction[axis];
    enter = std::max(enter, std::min(low, high));
    leave = std::min(leave, std::max(low, high));
  }
  return enter <= leave;
}

/// The time offset of a firing [ns], rounded to float32 seconds as in a recording.
std::int32_t sensor_time_offset(double offset_ns) {
  const auto seconds = static_cast<float>(offset_ns * 1e-9);
  return static_cast<std::int32_t>(std::llround(static_cast<double>(seconds) * 1e9));
}

/// Whether a direction lies in the blocked sector.
bool is_blocked(const LidarDefectConfig& defects, const Eigen::Vector3d& direction) {
  const double azimuth = std::atan2(direction.y(), direction.x());
  const double off = azimuth - defects.blocked_sector_center_deg * kRadiansPerDegree;
  return std::abs(std::remainder(off, 2.0 * std::numbers::pi)) <
         0.5 * defects.blocked_sector_width_deg * kRadiansPerDegree;
}

/// Fills the lanes of a packet with the firings of a line from column `first` on; lanes beyond the
/// last column repeat it.
void fill(const LidarConfig& config, const LidarCalibration& calibration,
          const ScanPattern& pattern, std::int64_t scan, int first, int line, BeamPacket& beams,
          BeamDirections& actual) {
  const int last = pattern.columns(scan) - 1;
  for (int lane = 0; lane < kRayPacketSize; ++lane) {
    const Firing firing = pattern.firing(scan, std::min(first + lane, last), line);
    const Eigen::Vector3d direction = firing.beam.direction();
    beams.nominal.x[lane] = static_cast<float>(direction.x());
    beams.nominal.y[lane] = static_cast<float>(direction.y());
    beams.nominal.z[lane] = static_cast<float>(direction.z());
    beams.time_offset_ns[lane] = sensor_time_offset(firing.time_offset_ns);
    beams.open[lane] =
        !is_blocked(config.defects, direction) && !enters_body_mask(config, direction);
    if (calibration.directions_are_nominal()) continue;
    const Eigen::Vector3d fired = true_angles(calibration, line, firing.beam).direction();
    actual.x[lane] = static_cast<float>(fired.x());
    actual.y[lane] = static_cast<float>(fired.y());
    actual.z[lane] = static_cast<float>(fired.z());
  }
}

}  // namespace

std::vector<bool> working_lines(const LidarConfig& config, std::uint64_t run_seed) {
  RandomStream random = rng(run_seed, "lidar.defects");
  const int lines = line_count(config);
  std::vector<bool> works(static_cast<std::size_t>(lines), true);
  if (config.pattern == LidarPattern::kRosette) return works;
  // Drawn without replacement.
  const auto dead = std::lround(config.defects.dead_ring_fraction * lines);
  for (long lost = 0; lost < dead;) {
    const auto ring = static_cast<std::size_t>(random.uniform(0.0, lines));
    if (ring >= works.size() || !works[ring]) continue;
    works[ring] = false;
    ++lost;
  }
  return works;
}

LidarBeams make_beams(const LidarConfig& config, const ScanPattern& pattern,
                      const LidarCalibration& calibration, const std::vector<bool>& works,
                      std::int64_t scan) {
  const int columns = pattern.columns(scan);
  const auto packets =
      static_cast<std::size_t>((columns + kRayPacketSize - 1) / kRayPacketSize * pattern.lines());
  const bool nominal = calibration.directions_are_nominal();
  LidarBeams result;
  result.packets.reserve(packets);
  if (!nominal) result.deviating.reserve(packets);
  BeamDirections unused;
  for (int first = 0; first < columns; first += kRayPacketSize) {
    for (int line = 0; line < pattern.lines(); ++line) {
      BeamPacket& beams = result.packets.emplace_back();
      fill(config, calibration, pattern, scan, first, line, beams,
           nominal ? unused : result.deviating.emplace_back());
      if (!works[static_cast<std::size_t>(line)]) beams.open.fill(false);
    }
  }
  return result;
}

void ScanTruth::clear() {
  normals.clear();
  surfaces.clear();
  points.clear();
  cosines.clear();
  range_sigmas.clear();
}

Lidar::Lidar(const LidarConfig& config, const RayCaster& caster, RunSeeds seeds)
    : config_(config),
      caster_(&caster),
      pattern_(config),
      calibration_(draw_calibration(config, seeds.robot)),
      model_(config, calibration_),
      noise_(seeds.run, "lidar.noise"),
      detection_(seeds.run, "lidar.detection"),
      intensity_noise_(seeds.run, "lidar.intensity"),
      direction_noise_(seeds.run, "lidar.direction"),
      works_(working_lines(config, seeds.robot)),
      beams_(make_beams(config, pattern_, calibration_, works_, 0)),
      columns_(pattern_.columns(0)),
      returns_(static_cast<std::size_t>(pattern_.lines())),
      before_(config.beam.is_line() ? 0 : returns_.size()),
      received_(returns_.size()),
      footprint_(config.beam),
      edges_(pattern_.lines(), pattern_.max_columns()),
      // Six sigma beyond the limit: noise cannot bring farther hits back into range.
      reach_(static_cast<float>(config.range_max + model_.largest_range_error())) {
  for (const Material& material : caster.materials()) {
    reflectivity_.push_back(static_cast<float>(material.reflectivity));
  }
  for (const Person& person : caster.people()) {
    reflectivity_.push_back(static_cast<float>(person.material.reflectivity));
  }
}

int Lidar::lanes_of(int block) const {
  return std::min(kRayPacketSize, columns_ - block * kRayPacketSize);
}

LidarScan Lidar::scan(Time start, const Trajectory& T_world_lidar, ScanTruth* truth) {
  assert(!T_world_lidar.empty());
  if (truth != nullptr) truth->clear();
  LidarScan scan;
  scan.stamp = start;
  scan.end = start + period();
  const std::int64_t index = (start + period() / 2) / period();
  if (!pattern_.repeats()) take_beams(index);
  scan.points.reserve(returns_.size() * static_cast<std::size_t>(columns_));
  PoseCursor cursor(T_world_lidar);
  std::vector<Pose> poses(kRayPacketSize + 1);
  const double column_ns = pattern_.column_period_ns();
  const double begin_ns = pattern_.first_column_ns(index);
  const int blocks = (columns_ + kRayPacketSize - 1) / kRayPacketSize;
  poses.back() = cursor.at(start + std::llround(begin_ns));
  edges_.clear();
  // An edge is known once the next block is cast: with footprints, points follow a block later.
  for (int block = 0; block < blocks; ++block) {
    const int first = block * kRayPacketSize;
    poses.front() = poses.back();
    for (int lane = 1; lane <= kRayPacketSize; ++lane) {
      const int column = first + std::min(lane, lanes_of(block));
      poses[lane] = cursor.at(start + std::llround(column * column_ns + begin_ns));
    }
    aim(block, poses);
    receive(block, start);
    if (config_.beam.is_line()) {
      append_points(block, returns_, scan, truth);
      continue;
    }
    mark_edges(block);
    if (block > 0) finish_before(block - 1, scan, truth);
    std::swap(returns_, before_);
  }
  if (!config_.beam.is_line()) finish_before(blocks - 1, scan, truth);
  return scan;
}

/// Replaces the beams by those of the pattern's scan `index`.
void Lidar::take_beams(std::int64_t index) {
  beams_ = make_beams(config_, pattern_, calibration_, works_, index);
  columns_ = pattern_.columns(index);
}

/// Rays of a block of columns: within one column, pose and time are blended linearly between its
/// begin and the next column's (55 us apart: exact to well below a micrometre).
void Lidar::aim(int block, const std::vector<Pose>& column_poses) {
  constexpr int kEntries = 12;  // of the rotation, row by row, then the translation
  alignas(64) std::array<RayPacket::Lanes, kEntries> begin;
  alignas(64) std::array<RayPacket::Lanes, kEntries> change;
  Eigen::Matrix<double, kEntries, 1> here, next;
  const auto flatten = [](const Pose& pose, Eigen::Matrix<double, kEntries, 1>& entries) {
    Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(entries.data()) = pose.R();
    entries.tail<3>() = pose.translation;
  };
  flatten(column_poses.front(), here);
  for (int lane = 0; lane < kRayPacketSize; ++lane) {
    flatten(column_poses[lane + 1], next);
    for (int entry = 0; entry < kEntries; ++entry) {
      begin[entry][lane] = static_cast<float>(here[entry]);
      change[entry][lane] = static_cast<float>(next[entry] - here[entry]);
    }
    here = next;
  }
  for (int line = 0; line < pattern_.lines(); ++line) {
    const BeamDirections& beams = beams_.actual(block * pattern_.lines() + line);
    RayPacket& rays = returns_[line].rays;
    const auto fraction = static_cast<float>(pattern_.delay_ns(line) / pattern_.column_period_ns());
    const auto at = [&](int entry, int lane) {
      return begin[entry][lane] + fraction * change[entry][lane];
    };
    for (int i = 0; i < kRayPacketSize; ++i) {
      rays.direction_x[i] = at(0, i) * beams.x[i] + at(1, i) * beams.y[i] + at(2, i) * beams.z[i];
      rays.direction_y[i] = at(3, i) * beams.x[i] + at(4, i) * beams.y[i] + at(5, i) * beams.z[i];
      rays.direction_z[i] = at(6, i) * beams.x[i] + at(7, i) * beams.y[i] + at(8, i) * beams.z[i];
      rays.origin_x[i] = at(9, i);
      rays.origin_y[i] = at(10, i);
      rays.origin_z[i] = at(11, i);
    }
  }
}

/// Casts the rays of a packet, people included, and finds the strengths of their returns.
void Lidar::cast(const std::array<Time, kRayPacketSize>& stamps, int count, Returns& each) const {
  caster_->cast(each.rays, reach_, each.hits, count);
  if (!caster_->people().empty()) {
    intersect_people(caster_->people(), each.rays, stamps, caster_->first_moving_surface(), reach_,
                     each.hits);
  }
  const RayPacket& rays = each.rays;
  const HitPacket& hits = each.hits;
  LaneValues reflectivity;
  for (int i = 0; i < kRayPacketSize; ++i) {
    each.cosine[i] =
        -(hits.normal_x[i] * rays.direction_x[i] + hits.normal_y[i] * rays.direction_y[i] +
          hits.normal_z[i] * rays.direction_z[i]);
    reflectivity[i] = hits.surface[i] < 0 ? 0.0F : reflectivity_[hits.surface[i]];
  }
  if (caster_->has_relief()) {
    for (int i = 0; i < kRayPacketSize; ++i) {
      if (hits.surface[i] < 0 || hits.surface[i] >= caster_->first_moving_surface()) continue;
      reflectivity[i] = std::min(reflectivity[i] * hits.texture[i], 1.0F);
    }
  }
  model_.strengths(reflectivity, each.cosine, each.strength);
}

void Lidar::receive(int block, Time start) {
  for (int line = 0; line < pattern_.lines(); ++line) {
    const BeamPacket& beams = beams_.packets[block * pattern_.lines() + line];
    std::array<Time, kRayPacketSize> stamps;
    for (int i = 0; i < kRayPacketSize; ++i) stamps[i] = start + beams.time_offset_ns[i];
    cast(stamps, lanes_of(block), returns_[line]);
  }
}

}  // namespace aims
