// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/jobs/job_results.hpp"
#include "core/error.hpp"
#include "core/files/folder_lock.hpp"

namespace aims {

/// A job as jobs.csv lists it: enough to say what is missing, without scenarios or this code.
struct ListedJob {
  std::string id;
  std::string scenario;
  std::string seed;
  std::string estimator;  ///< with its settings and those of the scenario
};

/// The folder of a sweep: plan.yaml, jobs.csv, jobs/ID.json, shards/I-of-N/.lock.
class SweepFolder {
 public:
  explicit SweepFolder(std::filesystem::path path) : path_(std::move(path)) {}

  /// Makes the folder one of that plan (as YAML) and those jobs, or checks that it is. Error when it is
  /// something else or of other jobs; with `renew` it becomes one of these, and results that are
  /// also of these stay valid.
  Result<void> enter(const std::string& plan, std::span<const Job> jobs, bool renew) const;

  /// Every job that the sweep is to do. Error when the folder is not of a sweep.
  Result<std::vector<ListedJob>> listed() const;

  /// The text of plan.yaml.
  Result<std::string> plan() const;

  JobResults jobs() const { return JobResults(path_ / "jobs"); }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace aims
