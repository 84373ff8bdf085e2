// SPDX-License-Identifier: BSD-3-Clause
#include "sim/environment/stretches.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/environment/bent_corridor.hpp"
#include "sim/environment/corridor_pieces.hpp"

namespace aims {
namespace {

constexpr double kFromEnd = 1.0;  ///< where people turn before an end, or a change of floor [m]
constexpr double kFromCrossing = 0.5;  ///< where they turn before a crossing corridor [m]
constexpr double kLeastLength = 2.0;   ///< of a stretch [m]
constexpr double kQuarterTurn = 0.5 * std::numbers::pi;

Stretch of_piece(const CorridorPiece& piece, double width) {
  return {piece.T_world_piece, walked_part(piece, width)};
}

std::vector<Stretch> of_corridor(const SceneConfig& scene) {
  const CorridorConfig& corridor = scene.corridor;
  const RampConfig& ramp = scene.ramp;
  if (has_bends(corridor)) {
    const auto pieces = corridor_pieces(corridor);
    const auto shorter = [](const CorridorPiece& a, const CorridorPiece& b) {
      return a.along.length() < b.along.length();
    };
    return {of_piece(*std::max_element(pieces.begin(), pieces.end(), shorter), corridor.width)};
  }
  const double begin = kFromEnd - corridor.margin;
  const double end = corridor.length + corridor.margin - kFromEnd;
  if (ramp.grade <= 0.0) return {{{}, {begin, end}}};
  return {{{}, {begin, ramp.start - kFromEnd}},
          {{}, {ramp.start + ramp.length + kFromEnd, end}, 0.0, ramp_rise(ramp)}};
}

std::vector<Stretch> of_garage(const GarageConfig& garage) {
  const double from_middle = garage.opening_distance + kFromEnd;
  const double begin = kFromEnd - garage.margin;
  return {
      {{}, {begin, garage.approach - from_middle}},
      {line_at(garage.approach, -garage.exit, kQuarterTurn), {begin, garage.exit - from_middle}}};
}

std::vector<Stretch> of_junction(const JunctionConfig& junction) {
  const double from_middle = 0.5 * junction.width + kFromCrossing;
  const double end = junction.branch + junction.margin - kFromEnd;
  const Pose crossing = line_at(junction.length, 0.0, kQuarterTurn);
  return {{{}, {kFromEnd - junction.margin, junction.length - from_middle}},
          {crossing, {-end, -from_middle}},
          {crossing, {from_middle, end}}};
}

Stretch of_tunnel(const TunnelConfig& tunnel) {
  const double begin = kFromEnd - tunnel.margin;
  const double length = tunnel.length + tunnel.margin - kFromEnd - begin;
  const double angle = begin / tunnel.radius;
  return {line_at(tunnel.radius * std::sin(angle), tunnel.radius * (1.0 - std::cos(angle)), angle),
          {0.0, length},
          length / tunnel.radius};
}

std::vector<Stretch> all_stretches(const SceneConfig& scene) {
  switch (scene.kind) {
    case SceneKind::kCorridor:
      return of_corridor(scene);
    case SceneKind::kGarage:
      return of_garage(scene.garage);
    case SceneKind::kJunction:
      return of_junction(scene.junction);
    case SceneKind::kTunnel:
      return {of_tunnel(scene.tunnel)};
    case SceneKind::kLoop: {
      std::vector<Stretch> stretches;
      for (const CorridorPiece& piece : loop_pieces(scene.loop)) {
        stretches.push_back(of_piece(piece, scene.loop.width));
      }
      return stretches;
    }
  }
  return {};
}

double width_of(const SceneConfig& scene) {
  switch (scene.kind) {
    case SceneKind::kCorridor:
      return scene.corridor.width;
    case SceneKind::kGarage:
      return scene.garage.width;
    case SceneKind::kJunction:
      return scene.junction.width;
    case SceneKind::kTunnel:
      return scene.tunnel.width;
    case SceneKind::kLoop:
      return scene.loop.width;
  }
  return 0.0;
}

}  // namespace

std::vector<Stretch> stretches_of(const SceneConfig& scene) {
  std::vector<Stretch> stretches = all_stretches(scene);
  const auto is_short = [](const Stretch& each) { return each.along.length() < kLeastLength; };
  const bool any = !std::all_of(stretches.begin(), stretches.end(), is_short);
  if (any && stretches.size() > 1) std::erase_if(stretches, is_short);
  return stretches;
}

Result<void> validate_people(const SceneConfig& scene) {
  if (scene.people.count == 0) return {};
  if (auto ok = validate(scene.people, width_of(scene)); !ok) return ok;
  for (const Stretch& each : stretches_of(scene)) {
    if (each.along.length() > 0.0) return {};
  }
  return failure("scene.people.count: expected 0, since no level stretch of corridor has room");
}

}  // namespace aims
