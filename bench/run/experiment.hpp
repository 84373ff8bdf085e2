// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "bench/run/gates.hpp"
#include "bench/run/run.hpp"
#include "bench/run/scenario.hpp"
#include "bench/run/score_record.hpp"
#include "core/error.hpp"

namespace aims {

struct ExperimentOptions {
  std::vector<std::uint64_t> seeds = {1};
  std::filesystem::path out;  ///< folder of results
  bool overwrite = false;     ///< replace a folder of results that exists
  int jobs = 1;               ///< threads
  bool pictures = true;
};

/// What an experiment yields besides the files that it wrote.
struct Experiment {
  std::vector<RunRecord> runs;      ///< one per seed, in order
  std::vector<GateCheck> failures;  ///< expectations that do not hold over all seeds
  bool complete = true;             ///< false when the observer ended it early
  std::filesystem::path folder;
  std::vector<std::string> warnings;  ///< e.g. a picture that could not be drawn
};

/// Called with the seed under way; returning false ends the experiment with what there is.
using ExperimentObserver = std::function<bool(std::uint64_t seed, const Progress&)>;

/// Runs a scenario for every seed and writes results: one seed straight into `out`; several into
/// `out/seed-N`, with a summary over them. Nothing is written when the scenario cannot run.
Result<Experiment> run_experiment(const Scenario& scenario, const ExperimentOptions& options,
                                  const ExperimentObserver& observer);

}  // namespace aims
