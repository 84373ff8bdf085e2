// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string>

#include "core/error.hpp"

namespace aims {

/// The ids of the jobs that a tuning asked for, in tune_jobs.csv of its folder: jobs of an earlier
/// plan may lie beside them. Error when it cannot be written.
Result<void> write_tune_jobs(const std::filesystem::path& folder, const std::set<std::string>& ids);

/// None where the folder has no such file.
std::optional<std::set<std::string>> read_tune_jobs(const std::filesystem::path& folder);

}  // namespace aims
