// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "render/film/filmed_sequence.hpp"

namespace aims {

/// Writes trajectories, and NAME-map-top and NAME-map-side when there is a map, each with each of
/// the endings (".svg", ".pdf"). Returns the names of the files.
Result<std::vector<std::string>> write_vector_pictures(const FilmedSequence& sequence,
                                                       const std::vector<std::string>& endings,
                                                       const std::filesystem::path& folder);

}  // namespace aims
