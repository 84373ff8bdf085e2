// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "core/error.hpp"
#include "core/files/yaml_config.hpp"

namespace aims {

/// As `load_config` of these keys of the top level alone, whatever else the file and its bases
/// hold: what a listing needs of a file, at a fraction of the cost.
Result<void> load_keys(const std::filesystem::path& file, std::span<const std::string> keys,
                       const CollectFields& collect, const std::filesystem::path& named = {});

}  // namespace aims
