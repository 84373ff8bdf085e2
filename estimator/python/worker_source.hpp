// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

namespace aims {

/// worker.py, which is part of the program, so that nothing is looked up at run time.
extern const std::string_view kPythonWorker;

}  // namespace aims
