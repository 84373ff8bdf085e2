// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "bench/studies/suite.hpp"
#include "core/error.hpp"

namespace aims {

/// True when `folder` holds the suite.json of a suite, finished or not.
bool holds_suite(const std::filesystem::path& folder);

/// Makes `folder` a suite's: writes a suite.json without scenarios when there is none.
Result<void> mark_suite(const std::filesystem::path& folder);

/// Writes suite.json, suite.csv, suite.md, timings.csv and the pictures of the families; see
/// docs/results.md. Only timings.csv has times in it.
Result<void> write_suite(const Suite& suite, const std::filesystem::path& folder);

}  // namespace aims
