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

BeamFootprint::BeamFootprint(const LidarBeamConfig& beam) : beam_(beam) {
  // A lattice of rank one: sixteen levels along each axis, so that an edge of any direction divides
  // the footprint in steps of a sixteenth.
  constexpr int kStep = 7;
  for (int i = 0; i < kRayPacketSize; ++i) {
    const double u = (i + 0.5) / kRayPacketSize - 0.5;
    const double v = (i * kStep % kRayPacketSize + 0.5) / kRayPacketSize - 0.5;
    shift_across_[i] = static_cast<float>(u * beam.exit_width);
    shift_up_[i] = static_cast<float>(v * beam.exit_height);
    turn_across_[i] = static_cast<float>(u * beam.divergence_horizontal);
    turn_up_[i] = static_cast<float>(v * beam.divergence_vertical);
    scale_[i] = 1.0F / std::hypot(1.0F, turn_across_[i], turn_up_[i]);
  }
}

RayPacket BeamFootprint::parts(const RayPacket& rays, int lane) const {
  const Eigen::Vector3f origin = origin_of(rays, lane);
  const Eigen::Vector3f direction = direction_of(rays, lane);
  const Eigen::Vector3f across = Eigen::Vector3f::UnitZ().cross(direction).normalized();
  const Eigen::Vector3f up = direction.cross(across);
  RayPacket spread;
  for (int i = 0; i < kRayPacketSize; ++i) {
    const float side = shift_across_[i];
    const float rise = shift_up_[i];
    spread.origin_x[i] = origin.x() + side * across.x() + rise * up.x();
    spread.origin_y[i] = origin.y() + side * across.y() + rise * up.y();
    spread.origin_z[i] = origin.z() + side * across.z() + rise * up.z();
    const float yaw = turn_across_[i];
    const float pitch = turn_up_[i];
    spread.direction_x[i] = scale_[i] * (direction.x() + yaw * across.x() + pitch * up.x());
    spread.direction_y[i] = scale_[i] * (direction.y() + yaw * across.y() + pitch * up.y());
    spread.direction_z[i] = scale_[i] * (direction.z() + yaw * across.z() + pitch * up.z());
  }
  return spread;
}

RayPacket BeamFootprint::border(const RayPacket& rays, int side) const {
  const auto pitch = static_cast<float>(0.5 * side * beam_.divergence_vertical);
  const auto rise = static_cast<float>(0.5 * side * beam_.exit_height);
  const float scale = 1.0F / std::hypot(1.0F, pitch);
  RayPacket turned = rays;
  for (int i = 0; i < kRayPacketSize; ++i) {
    // Perpendicular to the beam, in its vertical plane.
    const float x = rays.direction_x[i];
    const float y = rays.direction_y[i];
    const float z = rays.direction_z[i];
    const float level = std::sqrt(std::max(x * x + y * y, 1e-12F));
    const float up_x = -z * x / level;
    const float up_y = -z * y / level;
    turned.origin_x[i] += rise * up_x;
    turned.origin_y[i] += rise * up_y;
    turned.origin_z[i] += rise * level;
    turned.direction_x[i] = scale * (x + pitch * up_x);
    turned.direction_y[i] = scale * (y + pitch * up_y);
    turned.direction_z[i] = scale * (z + pitch * level);
  }
  return turned;
}

double BeamFootprint::half_angle(double distance) const {
  return 0.5 * (beam_.divergence_horizontal + beam_.exit_width / distance);
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

void EdgeMap::mark_beside(int ring, int before, int reach) {
  const int begin = std::max(before - reach + 1, 0);
  const int end = std::min(before + reach, columns_ - 1);
  for (int column = begin; column <= end; ++column) mark(ring, column, kBeside);
}

bool EdgeMap::any(int ring, int first, int places) const {
  std::uint8_t found = 0;
  for (int i = 0; i < kRayPacketSize; ++i) found |= marks_[index(ring, first + i)];
  return (found & places) != 0;
}

}  // namespace aims
