// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace aims {

/// Writes the pages of a folder that was just filled and says where they are. A page that cannot be
/// written is a warning: the results are there.
void show_reports(const std::filesystem::path& folder);

}  // namespace aims
