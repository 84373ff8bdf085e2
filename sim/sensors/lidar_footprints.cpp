// SPDX-License-Identifier: BSD-3-Clause
// Footprints over edges: where they may be, and what they return.
#include <algorithm>
#include <cmath>

#include "sim/sensors/lidar.hpp"

namespace aims {

/// Marks the firings beside every step in range within the newest block, to the block before, and
/// between its rings.
void Lidar::mark_edges(int block) {
  const int lanes = lanes_of(block);
  const int first = block * kRayPacketSize;
  for (int ring = 0; ring < pattern_.lines(); ++ring) {
    const Returns& each = returns_[ring];
    const auto& surface = each.hits.surface;
    if (block > 0) mark_edge(ring, first - 1, before_[ring], kRayPacketSize - 1, each, 0);
    for (int lane = 0; lane + 1 < lanes; ++lane) {
      if (surface[lane] == surface[lane + 1]) continue;  // most pairs: no call
      mark_edge(ring, first + lane, each, lane, each, lane + 1);
    }
    if (!pattern_.has_rings() || ring + 1 == pattern_.lines()) continue;
    const Returns& above = returns_[ring + 1];
    for (int lane = 0; lane < lanes; ++lane) {
      if (surface[lane] == above.hits.surface[lane]) continue;
      if (!range_steps_between(each.rays, each.hits, lane, above.rays, above.hits, lane)) continue;
      edges_.mark(ring, first + lane, EdgeMap::kAbove);
      edges_.mark(ring + 1, first + lane, EdgeMap::kBelow);
    }
  }
}

/// Marks the firings whose footprint may reach a step between `column` and the next one.
void Lidar::mark_edge(int ring, int column, const Returns& a, int lane_a, const Returns& b,
                      int lane_b) {
  if (!range_steps_between(a.rays, a.hits, lane_a, b.rays, b.hits, lane_b)) return;
  const double nearer = std::min(a.hits.distance[lane_a], b.hits.distance[lane_b]);
  const double reach = std::ceil(footprint_.half_angle(nearer) / pattern_.column_angle());
  edges_.mark_beside(ring, column, static_cast<int>(std::min<double>(reach, kRayPacketSize - 1)));
}

/// Rings are far apart against the height of a footprint: few footprints reach the step between
/// them. Takes back the marks of those whose border is on the surface of its centre.
void Lidar::probe_borders(int block, int ring, EdgeMap::Place place, Time start) {
  const int first = block * kRayPacketSize;
  if (!edges_.any(ring, first, place)) return;
  const Returns& each = before_[ring];
  Returns border;
  border.rays = footprint_.border(each.rays, place == EdgeMap::kAbove ? 1 : -1);
  std::array<Time, kRayPacketSize> stamps;
  const BeamPacket& beams = beams_.packets[block * pattern_.lines() + ring];
  for (int i = 0; i < kRayPacketSize; ++i) stamps[i] = start + beams.time_offset_ns[i];
  cast(stamps, lanes_of(block), border);
  for (int lane = 0; lane < lanes_of(block); ++lane) {
    if (border.hits.surface[lane] == each.hits.surface[lane]) {
      edges_.unmark(ring, first + lane, place);
    }
  }
}

/// Resolves the footprints over edges in the block before the newest.
void Lidar::spread_beams(int block, Time start) {
  const int first = block * kRayPacketSize;
  for (int ring = 0; ring < pattern_.lines(); ++ring) {
    probe_borders(block, ring, EdgeMap::kAbove, start);
    probe_borders(block, ring, EdgeMap::kBelow, start);
    if (!edges_.any(ring, first, EdgeMap::kBeside | EdgeMap::kAbove | EdgeMap::kBelow)) continue;
    for (int lane = 0; lane < lanes_of(block); ++lane) {
      if (edges_.marked(ring, first + lane)) resolve_footprint(block, ring, lane, start);
    }
  }
}

/// Replaces the return of a marked firing by the strongest echo of its footprint; takes the mark
/// back when the whole footprint is on the surface of its centre.
void Lidar::resolve_footprint(int block, int ring, int lane, Time start) {
  Returns& each = before_[ring];
  Returns parts;
  parts.rays = footprint_.parts(each.rays, lane);
  std::array<Time, kRayPacketSize> stamps;
  stamps.fill(start + beams_.packets[block * pattern_.lines() + ring].time_offset_ns[lane]);
  cast(stamps, kRayPacketSize, parts);
  if (std::ranges::count(parts.hits.surface, each.hits.surface[lane]) == kRayPacketSize) {
    edges_.unmark(ring, block * kRayPacketSize + lane);
    return;
  }
  const Echo echo = strongest_echo(parts.hits, parts.strength, config_.beam.pulse_length);
  each.hits.surface[lane] = echo.lane < 0 ? -1 : parts.hits.surface[echo.lane];
  if (echo.lane < 0) return;
  each.hits.distance[lane] = echo.distance;
  each.hits.normal_x[lane] = parts.hits.normal_x[echo.lane];
  each.hits.normal_y[lane] = parts.hits.normal_y[echo.lane];
  each.hits.normal_z[lane] = parts.hits.normal_z[echo.lane];
  each.cosine[lane] = parts.cosine[echo.lane];
  each.strength[lane] = echo.strength;
}

void Lidar::finish_before(int block, LidarScan& scan, ScanTruth* truth) {
  spread_beams(block, scan.stamp);
  append_points(block, before_, scan, truth);
}

}  // namespace aims
