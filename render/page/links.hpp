// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "core/error.hpp"

namespace aims {

/// Error when a file of the folder is a link to one outside it: a page of results from elsewhere
/// must not show files of its reader.
Result<void> check_links(const std::filesystem::path& folder);

/// A path as a relative link: bytes that could mean anything else are percent-encoded.
std::string link_to(const std::filesystem::path& relative);

/// The last part of a folder's path, as its name in titles; "." and links are followed.
std::string folder_name(const std::filesystem::path& folder);

}  // namespace aims
