// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bench/jobs/job.hpp"
#include "core/error.hpp"

namespace aims {

/// A folder with one file per job, ID.json. A file is there whole or not at all, and is never
/// changed by another job, so that any number of processes, on any machines, may fill one folder.
class JobResults {
 public:
  explicit JobResults(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// What the job came to; none when it is not there or its file cannot be read.
  std::optional<JobResult> find(const std::string& id) const;

  /// The whole file of a job; none likewise.
  std::optional<Json> read(const std::string& id) const;

  /// Stores a result, over an earlier one of the same job. Error when it cannot be written.
  Result<void> put(const Job& job, const JobResult& result) const;

  /// Every id that there is a file of, sorted.
  std::vector<std::string> ids() const;

  const std::filesystem::path& path() const { return folder_; }

 private:
  std::filesystem::path file_of(const std::string& id) const { return folder_ / (id + ".json"); }

  std::filesystem::path folder_;
};

}  // namespace aims
