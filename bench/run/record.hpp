// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>

#include "bench/estimate/progress.hpp"
#include "bench/scenario/scenario.hpp"
#include "core/error.hpp"
#include "core/walk_outcome.hpp"
#include "recordings/bag/compression.hpp"

namespace aims {

struct RecordOptions {
  std::uint64_t seed = 1;
  std::filesystem::path bag;  ///< .bag, .mcap or folder/ to write; it must not exist
  bool overwrite = false;     ///< unless this is set
  BagCompression compression = BagCompression::kNone;
};

/// What a recording has become, besides its files.
struct RecordOutcome {
  bool complete = false;  ///< false when the observer ended it early
  double simulated_s = 0.0;
  double wall_s = 0.0;
  WalkOutcome walk;
  int left_out = 0;  ///< messages that would have needed a negative time
  std::uintmax_t bag_bytes = 0;
  std::filesystem::path truth;           ///< NAME.truth.tum: true poses of the body
  std::filesystem::path waypoint_times;  ///< NAME.waypoint_times.csv
};

/// Simulates the scenario and records what its sensors deliver, and the truth, as a ROS 1 bag, an
/// MCAP file or a folder of rosbag2, by the name; truth and waypoint times of the reference points
/// also beside it. It is NAME.partial until it is whole; killed at any moment, or without space,
/// this leaves a bag that opens there, or what `--recover` reads of the others. Error when the
/// scenario cannot be simulated or a file cannot be written.
Result<RecordOutcome> record(const Scenario& scenario, const RecordOptions& options,
                             const Observer& observer);

}  // namespace aims
