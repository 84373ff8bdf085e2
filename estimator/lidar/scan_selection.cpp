// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/lidar/scan_selection.hpp"

#include <algorithm>
#include <array>
#include <bit>

#include "estimator/lidar/voxel_hash.hpp"

namespace aims {
namespace {

/// Returns whose voxels are computed ahead: the memory of the table arrives meanwhile.
constexpr std::size_t kBlock = 32;

/// Added to the index of a return before its bits are mixed.
constexpr std::uint64_t kRankSeed = 0x9e3779b97f4a7c15ULL;

}  // namespace

std::uint64_t ScanSelection::key_of(const Candidate& candidate, float inverse_size) {
  const Float4 position{candidate.position.x(), candidate.position.y(), candidate.position.z(),
                        0.0F};
  const Int4 voxel = voxel_lanes(position, inverse_size);
  return voxel_key({voxel[0], voxel[1], voxel[2]});
}

bool ScanSelection::usable(const LidarPoint& point) const {
  const double squared = point.position.squaredNorm();
  return squared >= config_.min_range * config_.min_range &&  // false for a NaN
         squared <= config_.max_range * config_.max_range;
}

int ScanSelection::begin(const LidarScan& scan) {
  if (config_.leave_out_mixed) steps_.mark(scan);
  eligible_.resize(scan.points.size());
  int in_range = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const bool here = usable(scan.points[i]);
    const bool mixed = config_.leave_out_mixed && steps_.mixed(i);
    eligible_[count] = {scan.points[i].position, static_cast<std::int32_t>(i)};
    in_range += static_cast<int>(here);
    count += static_cast<std::size_t>(here && !mixed);
  }
  eligible_.resize(count);
  return in_range;
}

std::int32_t& ScanSelection::slot_of(std::uint64_t key, std::size_t home) {
  std::size_t i = home;
  while (slots_[i] != kFree && kept_[static_cast<std::size_t>(slots_[i])].key != key) {
    i = (i + 1) & (slots_.size() - 1);
  }
  return slots_[i];
}

void ScanSelection::keep(const Candidate& candidate, std::uint64_t key, std::int32_t& slot) {
  const std::uint64_t rank = mixed_bits(static_cast<std::uint64_t>(candidate.index) + kRankSeed);
  if (slot == kFree) {
    slot = static_cast<std::int32_t>(kept_.size());
    kept_.push_back({key, rank, candidate});
    return;
  }
  Kept& chosen = kept_[static_cast<std::size_t>(slot)];
  if (rank < chosen.rank) chosen = {key, rank, candidate};
}

void ScanSelection::select(double voxel, int limit, std::vector<int>& kept) {
  kept_.clear();
  slots_.assign(std::bit_ceil(2 * eligible_.size() + 1), kFree);
  const auto inverse_size = static_cast<float>(1.0 / voxel);
  std::array<std::uint64_t, kBlock> keys;
  std::array<std::size_t, kBlock> homes;
  for (std::size_t begin = 0; begin < eligible_.size(); begin += kBlock) {
    const std::size_t count = std::min(kBlock, eligible_.size() - begin);
    for (std::size_t j = 0; j < count; ++j) {
      keys[j] = key_of(eligible_[begin + j], inverse_size);
      homes[j] = mixed_bits(keys[j]) & (slots_.size() - 1);
      __builtin_prefetch(&slots_[homes[j]]);
    }
    for (std::size_t j = 0; j < count; ++j) {
      keep(eligible_[begin + j], keys[j], slot_of(keys[j], homes[j]));
    }
  }
  const std::size_t count = kept_.size();
  kept.resize(std::min(count, static_cast<std::size_t>(limit)));
  for (std::size_t i = 0; i < kept.size(); ++i) {
    kept[i] = kept_[i * count / kept.size()].candidate.index;
  }
  eligible_.clear();
  for (const Kept& each : kept_) eligible_.push_back(each.candidate);
}

void ScanSelection::thin(int limit, std::vector<int>& kept) const {
  const auto most = static_cast<std::size_t>(limit);
  // Odd: rings fire in turn, and most LiDARs have an even number of them.
  const std::size_t step = eligible_.size() > most ? (eligible_.size() / most + 1) | 1U : 1;
  kept.clear();
  for (std::size_t i = 0; i < eligible_.size(); i += step) kept.push_back(eligible_[i].index);
}

}  // namespace aims
