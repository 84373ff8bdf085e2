// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace aims {

/// Integer coordinates of a cubic voxel.
struct VoxelIndex {
  std::int32_t x = 0;
  std::int32_t y = 0;
  std::int32_t z = 0;
};

/// The largest integer not above `value`, which must fit.
inline std::int32_t floor_to_int(float value) {
  const auto towards_zero = static_cast<std::int32_t>(value);
  return towards_zero - static_cast<std::int32_t>(value < static_cast<float>(towards_zero));
}

/// The voxel of edge 1 / inverse_size that holds `point`.
inline VoxelIndex voxel_of(const Eigen::Vector3f& point, float inverse_size) {
  return {floor_to_int(point.x() * inverse_size), floor_to_int(point.y() * inverse_size),
          floor_to_int(point.z() * inverse_size)};
}

/// 63-bit key, unique within +-2^20 voxels along each axis.
inline std::uint64_t voxel_key(const VoxelIndex& v) {
  constexpr std::uint64_t kMask = (1U << 21U) - 1U;
  return ((static_cast<std::uint64_t>(v.x) & kMask) << 42U) |
         ((static_cast<std::uint64_t>(v.y) & kMask) << 21U) |
         (static_cast<std::uint64_t>(v.z) & kMask);
}

/// Mixes all bits into the low ones (finalizer of splitmix64): the keys of the voxels of a wall
/// differ in one or two coordinates only.
inline std::uint64_t mixed_bits(std::uint64_t bits) {
  bits = (bits ^ (bits >> 30U)) * 0xbf58476d1ce4e5b9ULL;
  bits = (bits ^ (bits >> 27U)) * 0x94d049bb133111ebULL;
  return bits ^ (bits >> 31U);
}

/// Open-addressing table from voxel keys to small integers; grows by doubling, never shrinks.
/// Clearing costs nothing: entries carry the generation in which they were written.
class VoxelHash {
 public:
  static constexpr std::int32_t kNone = -1;

  explicit VoxelHash(std::size_t expected = 1024) {
    std::size_t capacity = 16;
    while (capacity < 2 * expected) capacity *= 2;
    slots_.resize(capacity);
  }

  /// The value of `key`, or kNone.
  std::int32_t find(std::uint64_t key) const {
    for (std::size_t i = slot(key);; i = (i + 1) & (slots_.size() - 1)) {
      if (slots_[i].generation != generation_) return kNone;
      if (slots_[i].key == key) return slots_[i].value;
    }
  }

  /// The value of `key`; when it is new, `value` is stored first.
  std::int32_t find_or_insert(std::uint64_t key, std::int32_t value) {
    if (2 * (size_ + 1) > slots_.size()) grow();
    std::size_t i = slot(key);
    while (slots_[i].generation == generation_) {
      if (slots_[i].key == key) return slots_[i].value;
      i = (i + 1) & (slots_.size() - 1);
    }
    slots_[i] = {key, value, generation_};
    ++size_;
    return value;
  }

  void clear() {
    ++generation_;
    size_ = 0;
  }

  std::size_t size() const { return size_; }

  /// Memory that the table holds [bytes].
  std::size_t memory() const { return slots_.capacity() * sizeof(Slot); }

  /// Slots looked at to find `key`: 1 at best.
  int probes(std::uint64_t key) const {
    int count = 1;
    for (std::size_t i = slot(key); slots_[i].generation == generation_ && slots_[i].key != key;
         i = (i + 1) & (slots_.size() - 1)) {
      ++count;
    }
    return count;
  }

 private:
  struct Slot {
    std::uint64_t key = 0;
    std::int32_t value = kNone;
    std::uint32_t generation = 0;
  };

  std::size_t slot(std::uint64_t key) const { return mixed_bits(key) & (slots_.size() - 1); }

  void grow() {
    std::vector<Slot> old(2 * slots_.size());
    old.swap(slots_);
    size_ = 0;
    for (const Slot& each : old) {
      if (each.generation == generation_) find_or_insert(each.key, each.value);
    }
  }

  std::vector<Slot> slots_;
  std::size_t size_ = 0;
  std::uint32_t generation_ = 1;
};

}  // namespace aims
