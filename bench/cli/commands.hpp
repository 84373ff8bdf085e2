// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>

namespace aims {

/// Each adds one subcommand; when it is given, its work's exit code goes to `exit_code`.
/// `scenario_folder` is where bare scenario names are looked up.
void add_run_command(CLI::App& app, const std::filesystem::path& scenario_folder, int& exit_code);
void add_render_command(CLI::App& app, const std::filesystem::path& scenario_folder,
                        int& exit_code);
void add_simulate_command(CLI::App& app, const std::filesystem::path& scenario_folder,
                          int& exit_code);
void add_estimate_command(CLI::App& app, int& exit_code);
void add_info_command(CLI::App& app, int& exit_code);
void add_check_command(CLI::App& app, int& exit_code);
void add_suite_command(CLI::App& app, const std::filesystem::path& scenario_folder, int& exit_code);
void add_report_command(CLI::App& app, int& exit_code);
void add_score_command(CLI::App& app, int& exit_code);
void add_compare_command(CLI::App& app, int& exit_code);
void add_detectors_command(CLI::App& app, const std::filesystem::path& scenario_folder,
                           int& exit_code);
void add_ablate_command(CLI::App& app, const std::filesystem::path& scenario_folder,
                        int& exit_code);
void add_consistency_command(CLI::App& app, const std::filesystem::path& scenario_folder,
                             int& exit_code);
void add_sweep_command(CLI::App& app, const std::filesystem::path& scenario_folder, int& exit_code);
void add_merge_command(CLI::App& app, int& exit_code);
void add_tune_command(CLI::App& app, const std::filesystem::path& scenario_folder, int& exit_code);
void add_list_command(CLI::App& app, const std::filesystem::path& scenario_folder, int& exit_code);
void add_config_command(CLI::App& app, const std::filesystem::path& scenario_folder,
                        int& exit_code);

}  // namespace aims
