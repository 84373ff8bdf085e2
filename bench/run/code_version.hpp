// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

namespace aims {

/// Hash, taken at build time, of everything that decides what a run yields: the sources that
/// simulate, estimate and score, the robot's model, the compiler and its flags.
std::string_view code_version();

/// As `code_version`, of what simulates alone: it decides the measurements and the truth of a run.
std::string_view simulator_version();

}  // namespace aims
