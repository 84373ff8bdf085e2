// SPDX-License-Identifier: BSD-3-Clause
#include "sim/sensors/beam_footprint.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace aims {
namespace {

/// Smaller steps in range are below the noise [m].
constexpr float kLeastStep = 0.02F;

Eigen::Vector3f origin_of(const RayPacket& rays, int lane) {
  return {rays.origin_x[lane], rays.origin_y[lane], rays.origin_z[lane]};
}

Eigen::Vector3f direction_of(const RayPacket& rays, int lane) {
  return {rays.direction_x[lane], rays.direction_y[lane], rays.direction_z[lane]};
}

Eigen::Vector3f normal_of(const HitPacket& hits, int lane) {
  return {hits.normal_x[lane], hits.normal_y[lane], hits.normal_z[lane]};
}

/// Distance at which ray b meets the plane of hit a; infinite when it leads away from it.
float distance_to_plane(const RayPacket& rays_a, const HitPacket& hits_a, int a,
                        const RayPacket& rays_b, int b) {
  const Eigen::Vector3f normal = normal_of(hits_a, a);
  const Eigen::Vector3f direction = direction_of(rays_a, a);
  const float along = normal.dot(direction_of(rays_b, b));
  if (along >= 0.0F) return std::numeric_limits<float>::infinity();
  const Eigen::Vector3f to_hit =
      origin_of(rays_a, a) + hits_a.distance[a] * direction - origin_of(rays_b, b);
  return normal.dot(to_hit) / along;
}

}  // namespace

bool range_steps_between(const RayPacket& rays_a, const HitPacket& hits_a, int a,
                         const RayPacket& rays_b, const HitPacket& hits_b, int b) {
  if (hits_a.surface[a] == hits_b.surface[b]) return false;
  if (hits_a.surface[a] < 0 || hits_b.surface[b] < 0) return true;
  const float past_a = hits_b.distance[b] - distance_to_plane(rays_a, hits_a, a, rays_b, b);
  const float past_b = hits_a.distance[a] - distance_to_plane(rays_b, hits_b, b, rays_a, a);
  return (past_a > kLeastStep && past_b < -kLeastStep) ||
         (past_a < -kLeastStep && past_b > kLeastStep);
}

RayPacket footprint_rays(const LidarBeamConfig& beam, const RayPacket& rays, int lane) {
  // A lattice of rank one: sixteen levels along each axis, so that an edge of any direction divides
  // the footprint in steps of a sixteenth.
  constexpr int kStep = 7;
  const Eigen::Vector3f origin = origin_of(rays, lane);
  const Eigen::Vector3f direction = direction_of(rays, lane);
  const Eigen::Vector3f across = Eigen::Vector3f::UnitZ().cross(direction).normalized();
  const Eigen::Vector3f up = direction.cross(across);
  RayPacket spread;
  for (int i = 0; i < kRayPacketSize; ++i) {
    const float u = (static_cast<float>(i) + 0.5F) / kRayPacketSize - 0.5F;
    const float v = (static_cast<float>(i * kStep % kRayPacketSize) + 0.5F) / kRayPacketSize - 0.5F;
    const Eigen::Vector3f from = origin + u * static_cast<float>(beam.exit_width) * across +
                                 v * static_cast<float>(beam.exit_height) * up;
    const Eigen::Vector3f towards =
        (direction + u * static_cast<float>(beam.divergence_horizontal) * across +
         v * static_cast<float>(beam.divergence_vertical) * up)
            .normalized();
    spread.origin_x[i] = from.x();
    spread.origin_y[i] = from.y();
    spread.origin_z[i] = from.z();
    spread.direction_x[i] = towards.x();
    spread.direction_y[i] = towards.y();
    spread.direction_z[i] = towards.z();
  }
  return spread;
}

double footprint_half_angle(const LidarBeamConfig& beam, double distance) {
  return 0.5 * (beam.divergence_horizontal + beam.exit_width / distance);
}

Echo strongest_echo(const HitPacket& hits, const LaneValues& strength, double pulse_length) {
  std::array<int, kRayPacketSize> order;
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, {}, [&](int lane) { return hits.distance[lane]; });
  Echo best;
  float best_power = 0.0F;
  for (int first = 0; first < kRayPacketSize;) {
    float power = 0.0F;
    float moment = 0.0F;
    float most = 0.0F;
    int lane = -1;
    int next = first;
    for (; next < kRayPacketSize && hits.surface[order[next]] >= 0; ++next) {
      const float distance = hits.distance[order[next]];
      if (next > first && distance - hits.distance[order[next - 1]] > pulse_length) break;
      const float part = strength[order[next]] / (distance * distance * kRayPacketSize);
      power += part;
      moment += part * distance;
      if (part > most) lane = order[next];
      most = std::max(most, part);
    }
    if (power > best_power) {
      const float mean = moment / power;
      best = {mean, power * mean * mean, lane};
      best_power = power;
    }
    if (next == first) break;  // the rest are misses
    first = next;
  }
  return best;
}

EdgeMap::EdgeMap(int rings, int columns)
    : columns_(columns),
      stride_(static_cast<std::size_t>((columns + kRayPacketSize - 1) / kRayPacketSize) *
              kRayPacketSize),
      marks_(static_cast<std::size_t>(rings) * stride_, 0) {}

void EdgeMap::clear() { std::ranges::fill(marks_, std::uint8_t{0}); }

void EdgeMap::mark(int ring, int before, int reach) {
  const int begin = std::max(before - reach + 1, 0);
  const int end = std::min(before + reach, columns_ - 1);
  for (int column = begin; column <= end; ++column) mark_one(ring, column);
}

bool EdgeMap::any(int ring, int first) const {
  const auto begin = marks_.begin() + static_cast<std::ptrdiff_t>(index(ring, first));
  return std::any_of(begin, begin + kRayPacketSize, [](std::uint8_t mark) { return mark != 0; });
}

}  // namespace aims
