// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace aims {

/// Paths in a plan are relative to the plan's file: scenario files become paths from the working
/// directory. What is no file there stays as it is: the name of a scenario, or a path of a plan
/// that was stored with its results.
void resolve_scenarios(const std::filesystem::path& plan, std::vector<std::string>& scenarios);

/// The same for "@FILE" among settings.
void resolve_settings(const std::filesystem::path& plan, std::vector<std::string>& settings);

}  // namespace aims
