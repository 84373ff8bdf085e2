// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "bench/tuning/objective.hpp"
#include "bench/tuning/sweep_store.hpp"
#include "core/error.hpp"

namespace aims {

/// Where an optimizer came to a point.
struct TunedPoint {
  std::size_t index = 0;    ///< in the order of its points
  double generation = 0.0;  ///< 0: the first population
};

/// What the folder of `aims sweep` or `aims tune` holds, finished or not.
struct TuningSource {
  bool tuned = false;  ///< by an optimizer; else a design
  std::string plan;    ///< text of the plan
  MergedSweep units;   ///< of a tuning: on the sequences that it uses
  MergedSweep held_out;
  bool holds_out = false;  ///< the plan names held-out sequences, whether or not they were run
  std::vector<Objective> objectives;                 ///< a sweep's: that of the last merge
  std::map<std::vector<double>, TunedPoint> points;  ///< of a finished tuning, by their values
  std::vector<std::string> notes;                    ///< what could not be used
};

/// The jobs of folders of `aims sweep`, merged, with the objective of the merge.
TuningSource merged_source(MergedSweep units, Objective objective);

/// Whether the folder is that of a sweep (plan.yaml, jobs.csv) or of a tuning (tune.yaml).
bool holds_tuning(const std::filesystem::path& folder);

/// Reads the folder; jobs that are being written meanwhile are left out. Error when it holds
/// neither, or its plan cannot be read.
Result<TuningSource> read_tuning(const std::filesystem::path& folder);

}  // namespace aims
