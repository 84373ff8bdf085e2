// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "bench/tuning/tune.hpp"
#include "core/error.hpp"

namespace aims {

/// The chosen point as a configuration file to be laid on top of any scenario (`--set @FILE`), with
/// where it comes from as comments: the held-out verdict first, sequences, algorithm, code, plan.
/// Expects one objective and a chosen point.
std::string overlay_text(const TuneResult& result);

/// Writes `overlay_text` to a file, whole or not at all.
Result<void> write_overlay(const TuneResult& result, const std::filesystem::path& file);

}  // namespace aims
