// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "core/config.hpp"

namespace aims {

/// Nested YAML of every value that has an effect; `load_config` reads it back to equal values.
std::string dump_config(const Fields& fields);

/// As `dump_config`, each value followed by a comment: unit, allowed values, meaning, source.
std::string dump_annotated_config(const Fields& fields);

}  // namespace aims
