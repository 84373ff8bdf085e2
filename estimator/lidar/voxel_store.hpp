// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "estimator/lidar/voxel_hash.hpp"

namespace aims {

/// Voxels in order of creation, found by their keys. `Voxel` has the members `key` and `seen`, the
/// last insertion that touched it.
template <class Voxel>
class VoxelStore {
 public:
  /// Starts the next insertion.
  void begin_insertion() {
    ++insertions_;
    touched_.clear();
  }

  /// The voxel of `key`, created if missing; marked as seen by this insertion.
  Voxel& touch(std::uint64_t key) {
    const auto next = static_cast<std::int32_t>(voxels_.size());
    const std::int32_t at = index_.find_or_insert(key, next);
    if (at == next) voxels_.emplace_back().key = key;
    Voxel& voxel = voxels_[at];
    if (voxel.seen != insertions_) touched_.push_back(at);
    voxel.seen = insertions_;
    return voxel;
  }

  /// The voxel of `key`, or null.
  const Voxel* find(std::uint64_t key) const {
    const std::int32_t at = index_.find(key);
    return at == VoxelHash::kNone ? nullptr : &voxels_[at];
  }

  /// Index of the voxel of `key`, VoxelHash::kNone if it is missing. Dropping voxels changes it.
  std::int32_t index_of(std::uint64_t key) const { return index_.find(key); }
  Voxel& operator[](std::int32_t index) { return voxels_[static_cast<std::size_t>(index)]; }
  const Voxel& operator[](std::int32_t index) const {
    return voxels_[static_cast<std::size_t>(index)];
  }

  /// Calls `visit` with each voxel touched by this insertion.
  template <class Visit>
  void visit_touched(const Visit& visit) {
    for (const std::int32_t at : touched_) visit(voxels_[at]);
  }

  /// With more than `max_count` voxels, drops those with the largest `squared_distance`, a tenth of
  /// `max_count` at once, so that dropping stays rare. Returns whether it dropped any.
  template <class Distance>
  bool limit(std::size_t max_count, const Distance& squared_distance) {
    if (voxels_.size() <= max_count) return false;
    std::vector<decltype(squared_distance(voxels_.front()))> distances(voxels_.size());
    std::transform(voxels_.begin(), voxels_.end(), distances.begin(), squared_distance);
    const auto last = distances.begin() + static_cast<std::ptrdiff_t>(max_count - max_count / 10);
    std::nth_element(distances.begin(), last, distances.end());
    drop_if([&, farthest = *last](const Voxel& v) { return squared_distance(v) >= farthest; });
    return true;
  }

  /// Memory held [bytes].
  std::size_t memory() const { return voxels_.capacity() * sizeof(Voxel) + index_.memory(); }

  std::size_t size() const { return voxels_.size(); }
  bool empty() const { return voxels_.empty(); }
  auto begin() { return voxels_.begin(); }
  auto end() { return voxels_.end(); }
  auto begin() const { return voxels_.begin(); }
  auto end() const { return voxels_.end(); }

 private:
  template <class Predicate>
  void drop_if(const Predicate& predicate) {
    if (std::erase_if(voxels_, predicate) == 0) return;
    touched_.clear();
    index_.clear();
    for (std::size_t i = 0; i < voxels_.size(); ++i) {
      index_.find_or_insert(voxels_[i].key, static_cast<std::int32_t>(i));
    }
  }

  std::uint32_t insertions_ = 0;
  VoxelHash index_;
  std::vector<Voxel> voxels_;
  std::vector<std::int32_t> touched_;  ///< by the present insertion
};

}  // namespace aims
