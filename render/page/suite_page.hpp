// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "core/error.hpp"
#include "render/page/page_data.hpp"

namespace aims {

/// The page of a suite's folder, finished or not: suite.json as it is, each run's scores with a
/// link to its own page where one lies there, the ROC curves of detectors.json, and the comparison
/// with other results. A run or a detectors.json of the folder itself that cannot be read becomes a
/// note on the page. Error when suite.json is not that of a suite, or when what `options` names
/// cannot be read.
Result<PageData> suite_page(const std::filesystem::path& folder, const PageOptions& options);

/// A path as a relative link: bytes that could mean anything else are percent-encoded.
std::string link_to(const std::filesystem::path& relative);

}  // namespace aims
