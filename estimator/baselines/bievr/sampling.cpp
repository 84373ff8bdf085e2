// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/bievr/sampling.hpp"

#include <algorithm>
#include <functional>
#include <tuple>

namespace aims::bievr {
namespace {

/// A point by its voxel.
struct Entry {
  std::uint64_t key = 0;
  double distance = 0.0;  ///< squared, from the centre of the voxel [m^2]
  std::size_t index = 0;
};

/// Entries [begin, end) of one voxel, and its relief.
struct Group {
  std::size_t begin = 0;
  std::size_t end = 0;
  double relief = 0.0;
};

std::vector<Group> groups_of(const std::vector<Entry>& entries, const BumpMap& map) {
  std::vector<Group> groups;
  for (std::size_t begin = 0; begin < entries.size();) {
    std::size_t end = begin;
    while (end < entries.size() && entries[end].key == entries[begin].key) ++end;
    const BumpVoxel* voxel = map.observed(entries[begin].key);
    const bool counts = voxel != nullptr && end > begin + 1;
    groups.push_back({begin, end, counts ? voxel->relief : 0.0});
    begin = end;
  }
  return groups;
}

}  // namespace

std::vector<Eigen::Vector3d> thinned(const std::vector<Eigen::Vector3d>& points, double voxel) {
  std::vector<Entry> entries;
  entries.reserve(points.size());
  const auto inverse = static_cast<float>(1.0 / voxel);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const VoxelIndex at = voxel_of(points[i].cast<float>(), inverse);
    const Eigen::Vector3d centre = voxel * Eigen::Vector3d(at.x + 0.5, at.y + 0.5, at.z + 0.5);
    entries.push_back({voxel_key(at), (points[i] - centre).squaredNorm(), i});
  }
  std::ranges::stable_sort(entries, {}, [](const Entry& e) { return std::tie(e.key, e.distance); });
  std::vector<Eigen::Vector3d> chosen;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (i == 0 || entries[i].key != entries[i - 1].key) chosen.push_back(points[entries[i].index]);
  }
  return chosen;
}

Sample informed_sample(const std::vector<Eigen::Vector3d>& points, const BumpMap& map,
                       const Pose& T_world_body, std::size_t count) {
  if (points.size() <= count) return {points, 0};
  const Eigen::Matrix3d R = T_world_body.R();
  std::vector<Entry> entries;
  entries.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    entries.push_back({map.key_of(R * points[i] + T_world_body.translation), 0.0, i});
  }
  std::ranges::stable_sort(entries, {}, &Entry::key);
  std::vector<Group> groups = groups_of(entries, map);
  std::ranges::stable_sort(groups, std::ranges::greater(), &Group::relief);
  Sample sample;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    const std::size_t end = i < count ? groups[i].end : groups[i].begin + 1;
    for (std::size_t k = groups[i].begin; k < end; ++k) {
      sample.points.push_back(points[entries[k].index]);
    }
    if (i + 1 == std::min(count, groups.size())) sample.fine = sample.points.size();
  }
  return sample;
}

}  // namespace aims::bievr
