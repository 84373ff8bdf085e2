// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "bench/scenario/scenario.hpp"

namespace aims {

/// The description, which was written of the file, with what was set on top: as the configuration
/// of a run has it.
std::string description_with_settings(const Scenario& scenario);

/// That description without what was set on top.
std::string description_without_settings(const std::string& description);

}  // namespace aims
