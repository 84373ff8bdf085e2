// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "cli/command.hpp"

namespace aims {

/// Each declares one command; `scenarios` is where bare scenario names are looked up.
void declare_fidelity(Command command, const std::filesystem::path& scenarios);
void declare_fidelity_baselines(Command command, const std::filesystem::path& scenarios);
void declare_order(Command command, const std::filesystem::path& scenarios);
void declare_weak(Command command, const std::filesystem::path& scenarios);

}  // namespace aims
