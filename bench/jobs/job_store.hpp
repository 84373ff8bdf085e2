// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/jobs/job.hpp"
#include "bench/jobs/job_id.hpp"
#include "core/error.hpp"
#include "core/files/folder_lock.hpp"

namespace aims {

/// What is kept of a job besides its scores.
struct JobOutputs {
  bool trajectories = false;  ///< trajectory, diagnostics, map; truth and localizability
  bool weak_axis = false;     ///< error along the weak axis over time
};

/// A job as jobs.csv lists it: enough to name it without its scenario or this code.
struct ListedJob {
  std::string id;
  std::string scenario;
  std::string seed;
  std::string label;         ///< of the estimator
  std::string estimator;     ///< with its settings and those of the scenario
  std::string version = {};  ///< of scenario and estimator (job.hpp); empty: not known
};

/// The job's seed; 0 where the list names none.
std::uint64_t seed_of(const ListedJob& job);

/// The one layout of stored results:
///
///   jobs.csv                every job that was last asked for, one a row
///   jobs/ID.json            result of a job
///   jobs/ID/                its outputs, when asked for: estimate.tum, estimate.diagnostics.csv,
///                           estimate.map.ply, weak_axis.csv
///   sequences/ID/           truth.tum, localizability.csv, ... of a sequence, with trajectories
///   plan.yaml               of a sweep
///   settings.txt            of others: what is set on top of every scenario, one a line
///   shards/I-of-N/.lock     while a shard is worked on
///
/// A file appears at once, complete, and is decided by the id in its name, so that any number of
/// processes, on any machines, may fill one folder.
class JobStore {
 public:
  explicit JobStore(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Lists the jobs. With a `plan`, the folder must be new or of the same plan, code and scenarios;
  /// with `force` it becomes one of these, and results that are also of these stay valid.
  Result<void> enter(std::span<const Job> jobs, const std::string& plan, bool force) const;

  /// Error when the folder holds jobs of scenarios with other settings ("key=value") on top.
  Result<void> check_settings(const std::vector<std::string>& settings) const;
  /// The settings of its scenarios; none where the folder does not say.
  std::vector<std::string> settings() const;
  /// Notes the settings that its jobs have.
  Result<void> keep_settings(const std::vector<std::string>& settings) const;

  /// The jobs that were last asked for. Error when the folder is no job store.
  Result<std::vector<ListedJob>> listed() const;

  /// The text of plan.yaml.
  Result<std::string> plan() const;
  /// The code version that the plan's jobs are of.
  Result<std::string> code() const;

  /// What the job came to; none when it is not there or its file cannot be read.
  std::optional<JobResult> find(const std::string& id) const;
  /// The file of a job; none likewise.
  std::optional<Json> read(const std::string& id) const;
  /// Stores a result, over an earlier one of the same job. Error when it cannot be written.
  Result<void> put(const Job& job, const JobResult& result) const;
  /// Every id that there is a result of, sorted.
  std::vector<std::string> ids() const;

  /// Whether a finished job has those outputs.
  bool has(const std::string& id, const std::string& sequence, const JobOutputs& outputs) const;

  std::filesystem::path outputs_of(const std::string& id) const { return folder_ / "jobs" / id; }
  std::filesystem::path sequence_of(const std::string& id) const {
    return folder_ / "sequences" / id;
  }
  const std::filesystem::path& path() const { return folder_; }

 private:
  std::filesystem::path file_of(const std::string& id) const {
    return folder_ / "jobs" / (id + ".json");
  }

  std::filesystem::path folder_;
};

/// Name that a job's own trajectory, diagnostics and map have in `JobStore::outputs_of`.
inline constexpr const char* kEstimateName = "estimate";
inline constexpr const char* kWeakAxisFile = "weak_axis.csv";

/// Keeps others out of a store: of all of it, or of one shard while others have theirs.
struct StoreClaim {
  FolderLock folder;
  std::optional<FolderLock> shard;
};

/// Makes the folder and claims it. Error when it holds something else, or is in use.
Result<StoreClaim> claim_store(const std::filesystem::path& folder, const Shard& shard = {});

}  // namespace aims
