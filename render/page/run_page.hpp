// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "core/error.hpp"
#include "render/page/page_data.hpp"

namespace aims {

/// The page of one run, estimate or score: kind "run". The same folder gives the
/// same page, wherever it lies. Errors as of `read_run_folder`.
Result<PageData> run_page(const std::filesystem::path& folder);

}  // namespace aims
