// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/scoring/json_text.hpp"
#include "render/page/run_folder.hpp"

namespace aims {

/// The command that repeats the run, called in its folder, with the recording and the folders of
/// classes in Python as seen from there; null for scores of foreign trajectories.
Json repeat_command_json(const RunFolder& run);

}  // namespace aims
