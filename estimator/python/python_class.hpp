// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "estimator/python/python_estimator.hpp"
#include "estimator/python/python_process.hpp"

namespace aims {

/// Starts a process and imports the class "python:module.Class" within `limit_s` [s]; yields what
/// it says of it. Error with the reason why it cannot.
Result<std::vector<std::byte>> import_class(PythonProcess& process, std::string_view name,
                                            double limit_s);

/// The text of which worker.py makes the value.
std::string python_text(const PythonValue& value);

}  // namespace aims
