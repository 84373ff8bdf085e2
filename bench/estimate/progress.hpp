// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

namespace aims {

/// What a live stream is made of.
struct RunOptions {
  std::uint64_t seed = 1;
  int jobs = 1;  ///< threads; the results do not depend on it
};

/// How far a stream of measurements has come.
struct Progress {
  double simulated_s = 0.0;
  double expected_s = 0.0;
  double wall_s = 0.0;
};

/// Called between batches; returning false ends the work early with what there is.
using Observer = std::function<bool(const Progress&)>;

/// Called with each file that is about to be drawn; empty: nobody watches.
using DrawObserver = std::function<void(const std::filesystem::path& file)>;

inline void announce(const DrawObserver& observer, const std::filesystem::path& file) {
  if (observer) observer(file);
}

}  // namespace aims
