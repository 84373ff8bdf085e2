// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>

#include "core/error.hpp"

namespace aims {

/// All scalars of a YAML text that another program wrote, by their place: "group.key", and
/// "group.list.0" in lists. Errors name `name`, line and column; a text without bound is one.
Result<std::map<std::string, std::string>> yaml_scalars(const std::string& text,
                                                        const std::string& name);

}  // namespace aims
