// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "cli/command.hpp"
#include "core/error.hpp"

namespace aims {

struct WrittenPages;

/// Each declares one command; `scenarios` is where bare scenario names are looked up.
void declare_run(Command command, const std::filesystem::path& scenarios);
void declare_suite(Command command, const std::filesystem::path& scenarios);
void declare_sweep(Command command, const std::filesystem::path& scenarios);
void declare_merge(Command command, const std::filesystem::path& scenarios);
void declare_tune(Command command, const std::filesystem::path& scenarios);
void declare_ablation(Command command, const std::filesystem::path& scenarios);
void declare_sensitivity(Command command, const std::filesystem::path& scenarios);
void declare_consistency(Command command, const std::filesystem::path& scenarios);
void declare_detectors(Command command, const std::filesystem::path& scenarios);
void declare_compare(Command command);
void declare_faults(Command command, const std::filesystem::path& scenarios);
void declare_groups(Command command);
void declare_paper(Command command, const std::filesystem::path& scenarios);
void declare_study(Command command, const std::filesystem::path& scenarios);
void declare_simulate(Command command, const std::filesystem::path& scenarios);
void declare_estimate(Command command, const std::filesystem::path& scenarios);
void declare_benchmark(Command command, const std::filesystem::path& scenarios);
void declare_calibrate(Command command, const std::filesystem::path& scenarios);
void declare_score(Command command, const std::filesystem::path& scenarios);
void declare_info(Command command, const std::filesystem::path& scenarios);
void declare_check(Command command, const std::filesystem::path& scenarios);
void declare_convert(Command command, const std::filesystem::path& scenarios);
void declare_render(Command command, const std::filesystem::path& scenarios);
void declare_page(Command command, const std::filesystem::path& scenarios);
void declare_config(Command command, const std::filesystem::path& scenarios);
void declare_list(Command command, const std::filesystem::path& scenarios);
void declare_completion(Command command, const std::filesystem::path& scenarios);

/// Prints where pages are. Those that cannot be written are a warning: the results are there.
void print_written(const Result<WrittenPages>& written);

/// Writes the pages of a folder that was just filled and prints where they are, as above; unless
/// `quiet`, shows which one is being written.
void write_pages_of(const std::filesystem::path& folder, bool quiet);

/// Writes the page of one folder whose results are still to appear; prints nothing.
Result<void> write_page_of(const std::filesystem::path& folder, bool quiet);

}  // namespace aims
