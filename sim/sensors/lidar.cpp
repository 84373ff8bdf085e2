// SPDX-License-Identifier: BSD-3-Clause
#include "sim/sensors/lidar.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "sim/environment/people.hpp"

namespace aims {
namespace {

constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;

Duration scan_period(const LidarConfig& config) { return from_seconds(1.0 / config.rate); }

double column_period_ns(const LidarConfig& config) {
  return static_cast<double>(scan_period(config)) / config.columns;
}

double ring_interval_ns(const LidarConfig& config) {
  return std::min(1e3 * config.ring_interval_us, column_period_ns(config) / config.rings);
}

/// Direction of a firing in the LiDAR frame.
Eigen::Vector3d beam_direction(const LidarConfig& config, int ring, double time_offset_ns) {
  const double turned = time_offset_ns / static_cast<double>(scan_period(config));
  const double azimuth =
      config.start_azimuth_deg * kRadiansPerDegree - 2.0 * std::numbers::pi * turned;
  const double fraction = config.rings > 1 ? static_cast<double>(ring) / (config.rings - 1) : 0.0;
  const double elevation =
      kRadiansPerDegree * std::lerp(config.elevation_min_deg, config.elevation_max_deg, fraction);
  return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
          std::sin(elevation)};
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

/// The working rings: the dead ones are drawn without replacement.
std::vector<bool> working_rings(const LidarConfig& config, std::uint64_t run_seed) {
  RandomStream random = rng(run_seed, "lidar.defects");
  std::vector<bool> works(static_cast<std::size_t>(config.rings), true);
  const auto dead = std::lround(config.defects.dead_ring_fraction * config.rings);
  for (long lost = 0; lost < dead;) {
    const auto ring = static_cast<std::size_t>(random.uniform(0.0, config.rings));
    if (ring >= works.size() || !works[ring]) continue;
    works[ring] = false;
    ++lost;
  }
  return works;
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

/// Poses at rising times, found by walking along the trajectory.
class PoseCursor {
 public:
  explicit PoseCursor(const Trajectory& trajectory) : trajectory_(trajectory) {}

  Pose at(Time stamp) {
    while (next_ < trajectory_.size() && trajectory_[next_].stamp < stamp) ++next_;
    if (next_ == trajectory_.size()) return trajectory_.back().pose;
    if (next_ == 0) return trajectory_.front().pose;
    const StampedPose& before = trajectory_[next_ - 1];
    const StampedPose& after = trajectory_[next_];
    const double fraction =
        to_seconds(stamp - before.stamp) / to_seconds(after.stamp - before.stamp);
    return interpolate(before.pose, after.pose, fraction);
  }

 private:
  const Trajectory& trajectory_;
  std::size_t next_ = 0;
};

}  // namespace

Lidar::Lidar(const LidarConfig& config, const RayCaster& caster, std::uint64_t run_seed)
    : config_(config),
      caster_(&caster),
      noise_(run_seed, "lidar.noise"),
      detection_(run_seed, "lidar.detection"),
      returns_(static_cast<std::size_t>(config.rings)) {
  for (const Material& material : caster.materials()) {
    reflectivity_.push_back(static_cast<float>(material.reflectivity));
  }
  const std::vector<bool> works = working_rings(config, run_seed);
  for (const Person& person : caster.people()) {
    reflectivity_.push_back(static_cast<float>(person.material.reflectivity));
  }
  const int blocks = (config.columns + kRayPacketSize - 1) / kRayPacketSize;
  for (int block = 0; block < blocks; ++block) {
    for (int ring = 0; ring < config.rings; ++ring) {
      Beams& beams = beams_.emplace_back();
      for (int lane = 0; lane < kRayPacketSize; ++lane) {
        const int column = std::min(block * kRayPacketSize + lane, config.columns - 1);
        const double offset = column * column_period_ns(config) + ring * ring_interval_ns(config);
        const Eigen::Vector3d direction = beam_direction(config, ring, offset);
        beams.x[lane] = static_cast<float>(direction.x());
        beams.y[lane] = static_cast<float>(direction.y());
        beams.z[lane] = static_cast<float>(direction.z());
        beams.time_offset_ns[lane] = sensor_time_offset(offset);
        beams.open[lane] = works[static_cast<std::size_t>(ring)] &&
                           !is_blocked(config.defects, direction) &&
                           !enters_body_mask(config, direction);
      }
    }
  }
}

Duration Lidar::period() const { return scan_period(config_); }

LidarScan Lidar::scan(Time start, const Trajectory& T_world_lidar, ScanTruth* truth) {
  assert(!T_world_lidar.empty());
  LidarScan scan;
  scan.stamp = start;
  scan.end = start + period();
  scan.points.reserve(static_cast<std::size_t>(config_.rings) * config_.columns);
  PoseCursor cursor(T_world_lidar);
  std::vector<Pose> poses(kRayPacketSize + 1);
  const double column_ns = column_period_ns(config_);
  poses.back() = cursor.at(start);
  for (int first = 0; first < config_.columns; first += kRayPacketSize) {
    const int lanes = std::min(kRayPacketSize, config_.columns - first);
    poses.front() = poses.back();
    for (int lane = 1; lane <= kRayPacketSize; ++lane) {
      poses[lane] = cursor.at(start + std::llround((first + std::min(lane, lanes)) * column_ns));
    }
    const int block = first / kRayPacketSize;
    aim(block, poses);
    receive(block, lanes, start);
    append_points(block, lanes, scan, truth);
  }
  return scan;
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
  for (int ring = 0; ring < config_.rings; ++ring) {
    const Beams& beams = beams_[block * config_.rings + ring];
    RayPacket& rays = returns_[ring].rays;
    const auto fraction =
        static_cast<float>(ring * ring_interval_ns(config_) / column_period_ns(config_));
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

void Lidar::receive(int block, int lanes, Time start) {
  // Six sigma beyond the limit: noise cannot bring farther hits back into range.
  const auto reach = static_cast<float>(config_.range_max + 6.0 * config_.range_sigma);
  for (int ring = 0; ring < config_.rings; ++ring) {
    Returns& each = returns_[ring];
    caster_->cast(each.rays, reach, each.hits, lanes);
    if (!caster_->people().empty()) {
      const Beams& beams = beams_[block * config_.rings + ring];
      std::array<Time, kRayPacketSize> stamps;
      for (int i = 0; i < kRayPacketSize; ++i) stamps[i] = start + beams.time_offset_ns[i];
      intersect_people(caster_->people(), each.rays, stamps, caster_->first_moving_surface(), reach,
                       each.hits);
    }
    const RayPacket& rays = each.rays;
    const HitPacket& hits = each.hits;
    for (int i = 0; i < kRayPacketSize; ++i) {
      const float cosine =
          -(hits.normal_x[i] * rays.direction_x[i] + hits.normal_y[i] * rays.direction_y[i] +
            hits.normal_z[i] * rays.direction_z[i]);
      const float reflectivity = hits.surface[i] < 0 ? 0.0F : reflectivity_[hits.surface[i]];
      each.strength[i] = std::clamp(reflectivity * cosine, 0.0F, 1.0F);
    }
  }
}

bool Lidar::detected(float strength, float range) {
  const double probability = detection_probability(config_, strength, 1.0, range);
  return detection_.chance((1.0 - config_.miss_probability) * probability);
}

void Lidar::append_points(int block, int lanes, LidarScan& scan, ScanTruth* truth) {
  for (int lane = 0; lane < lanes; ++lane) {
    for (int ring = 0; ring < config_.rings; ++ring) {
      const Beams& beams = beams_[block * config_.rings + ring];
      const Returns& each = returns_[ring];
      const int surface = each.hits.surface[lane];
      if (surface < 0 || !beams.open[lane]) continue;
      if (!detected(each.strength[lane], each.hits.distance[lane])) continue;
      const double range = each.hits.distance[lane] + config_.range_sigma * noise_.normal();
      if (range < config_.range_min || range > config_.range_max) continue;
      LidarPoint& point = scan.points.emplace_back();
      point.position =
          static_cast<float>(range) * Eigen::Vector3f(beams.x[lane], beams.y[lane], beams.z[lane]);
      point.intensity = each.strength[lane];
      point.time_offset_ns = beams.time_offset_ns[lane];
      point.ring = static_cast<std::uint16_t>(ring);
      if (truth == nullptr) continue;
      const RayPacket& rays = each.rays;
      const Eigen::Vector3f origin(rays.origin_x[lane], rays.origin_y[lane], rays.origin_z[lane]);
      const Eigen::Vector3f direction(rays.direction_x[lane], rays.direction_y[lane],
                                      rays.direction_z[lane]);
      const Eigen::Vector3f normal(each.hits.normal_x[lane], each.hits.normal_y[lane],
                                   each.hits.normal_z[lane]);
      truth->normals.push_back(normal);
      truth->surfaces.push_back(surface);
      truth->points.emplace_back(origin + each.hits.distance[lane] * direction);
      truth->cosines.push_back(std::clamp(-normal.dot(direction), 0.0F, 1.0F));
    }
  }
}

}  // namespace aims
