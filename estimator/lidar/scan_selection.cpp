// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/lidar/scan_selection.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>

#include "estimator/lidar/voxel_hash.hpp"

namespace aims {
namespace {

/// Added to the index of a return before its bits are mixed.
constexpr std::uint64_t kRankSeed = 0x9e3779b97f4a7c15ULL;

constexpr std::uint64_t kHighestRank = std::numeric_limits<std::uint64_t>::max();

/// Runs whose places in the table are asked for ahead.
constexpr std::size_t kAhead = 16;

/// Place of the index in what is kept.
constexpr std::size_t kIndex = 3;

std::uint64_t rank_of(std::int32_t index) {
  return mixed_bits(static_cast<std::uint64_t>(index) + kRankSeed);
}

/// `a` if `first` holds, else `b`, without a branch.
std::uint64_t one_of(bool first, std::uint64_t a, std::uint64_t b) {
  const std::uint64_t mask = -static_cast<std::uint64_t>(first);
  return (a & mask) | (b & ~mask);
}

bool same_voxel(Int4 a, Int4 b) { return (lanes_of(a == b) & 7U) == 7U; }

std::uint64_t key_of(Int4 voxel) { return voxel_key({voxel[0], voxel[1], voxel[2]}); }

/// Its coordinates; the fourth number is the intensity, which follows them.
Float4 position_of(const LidarPoint& point) {
  static_assert(offsetof(LidarPoint, intensity) == 3 * sizeof(float));
  return load4(point.position.data());
}

}  // namespace

bool ScanSelection::usable(const LidarPoint& point) const {
  const double squared = point.position.squaredNorm();
  return squared >= config_.min_range * config_.min_range &&  // false for a NaN
         squared <= config_.max_range * config_.max_range;
}

/// Moves the grid from scan to scan by the steps of the additive sequence that fills a cube most
/// evenly (the powers of 1 / g, with g^4 = g + 1).
void ScanSelection::shift_grid() {
  constexpr std::array kSteps = {0.8191725133961645, 0.6710436067037893, 0.5497004779019703};
  for (std::size_t axis = 0; axis < kSteps.size(); ++axis) {
    grid_shift_[axis] = std::fmod(grid_shift_[axis] + kSteps[axis], 1.0);
  }
}

int ScanSelection::begin(const LidarScan& scan) {
  scan_ = &scan;
  shift_grid();
  if (config_.leave_out_mixed) steps_.mark(scan);
  candidates_.resize(scan.points.size());
  int in_range = 0;
  std::size_t count = 0;
  ring_count_ = 0;
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    ring_count_ = std::max(ring_count_, scan.points[i].ring + std::size_t{1});
    const bool here = usable(scan.points[i]);
    const bool at_step = config_.leave_out_mixed && steps_.marked(i);
    candidates_[count] = static_cast<std::int32_t>(i);
    in_range += static_cast<int>(here);
    count += static_cast<std::size_t>(here && !at_step);
  }
  candidates_.resize(count);
  return in_range;
}

/// Neighbours of a ring are mostly in one voxel: they are looked up together. Where a run ends is
/// as good as random, and so is which return has the lowest rank: no branch depends on it.
std::size_t ScanSelection::keep_one_per_run(float inverse_size) {
  const Float4 shift{static_cast<float>(grid_shift_[0]), static_cast<float>(grid_shift_[1]),
                     static_cast<float>(grid_shift_[2]), 0.0F};
  if (runs_.size() < candidates_.size()) runs_.resize(candidates_.size());
  last_.assign(ring_count_, Run());
  std::size_t count = 0;
  for (const std::int32_t index : candidates_) {
    const LidarPoint& point = scan_->points[static_cast<std::size_t>(index)];
    Run& run = last_[point.ring];
    const Int4 voxel = floored(position_of(point) * inverse_size + shift);
    const bool goes_on = same_voxel(run.voxel, voxel);
    run.place = one_of(goes_on, run.place, count);
    run.lowest = one_of(goes_on, run.lowest, kHighestRank);
    count += static_cast<std::size_t>(!goes_on);
    const std::uint64_t rank = rank_of(index);
    const bool lower = rank <= run.lowest;
    run.index = one_of(lower, static_cast<std::uint64_t>(index), run.index);
    run.lowest = one_of(lower, rank, run.lowest);
    run.voxel = voxel;
    Kept kept = voxel;
    kept[kIndex] = static_cast<std::int32_t>(run.index);
    runs_[run.place] = kept;
  }
  return count;
}

void ScanSelection::keep_one_per_voxel(std::span<const Kept> runs) {
  kept_.clear();
  slots_.assign(std::bit_ceil(runs.size() + runs.size() / 2 + 1), kFree);
  const auto home = [this](Kept run) { return mixed_bits(key_of(run)) & (slots_.size() - 1); };
  for (std::size_t k = 0; k < runs.size(); ++k) {
    if (k + kAhead < runs.size()) __builtin_prefetch(&slots_[home(runs[k + kAhead])]);
    const Kept run = runs[k];
    std::size_t i = home(run);
    while (slots_[i] != kFree && !same_voxel(kept_[static_cast<std::size_t>(slots_[i])], run)) {
      i = (i + 1) & (slots_.size() - 1);
    }
    if (slots_[i] == kFree) {
      slots_[i] = static_cast<std::int32_t>(kept_.size());
      kept_.push_back(run);
    } else if (Kept& kept = kept_[static_cast<std::size_t>(slots_[i])];
               rank_of(run[kIndex]) < rank_of(kept[kIndex])) {
      kept = run;
    }
  }
}

void ScanSelection::select(double voxel, int limit, std::vector<int>& kept) {
  const std::size_t runs = keep_one_per_run(static_cast<float>(1.0 / voxel));
  keep_one_per_voxel({runs_.data(), runs});
  const std::size_t count = kept_.size();
  candidates_.resize(count);
  for (std::size_t i = 0; i < count; ++i) candidates_[i] = kept_[i][kIndex];
  kept.resize(std::min(count, static_cast<std::size_t>(limit)));
  for (std::size_t i = 0; i < kept.size(); ++i) kept[i] = candidates_[i * count / kept.size()];
}

void ScanSelection::thin(int limit, std::vector<int>& kept) const {
  const auto most = static_cast<std::size_t>(limit);
  // Odd: rings fire in turn, and most LiDARs have an even number of them.
  const std::size_t step = candidates_.size() > most ? (candidates_.size() / most + 1) | 1U : 1;
  kept.clear();
  for (std::size_t i = 0; i < candidates_.size(); i += step) kept.push_back(candidates_[i]);
}

}  // namespace aims
