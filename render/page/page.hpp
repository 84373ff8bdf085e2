// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench/estimate/progress.hpp"
#include "core/error.hpp"
#include "render/page/page_data.hpp"
#include "render/page/tuning_source.hpp"

namespace aims {

/// Name of a page in the folder that it shows.
inline constexpr const char* kPageFile = "page.html";

/// What `write_pages` wrote.
struct WrittenPages {
  std::vector<std::filesystem::path> pages;
  std::vector<std::string> warnings;  ///< runs of a suite whose page could not be written, and why
};

/// Writes the page of a folder to `file`: of one run, of its seeds, of a suite, or of a sweep.
/// Error, with the file and what was expected, when the folder holds nothing of these or something
/// broken.
Result<void> write_page(const std::filesystem::path& folder, const std::filesystem::path& file,
                        PageOptions options = {});

/// Writes every page of a folder of results, each as `kPageFile` into the folder that it shows: one
/// run; each seed of `aims run`, then all of them; a suite and, before it, those of its runs that
/// kept trajectories, unless their page is newer than their scores; a sweep. Runs of a suite stop
/// nothing else.
Result<WrittenPages> write_pages(const std::filesystem::path& folder,
                                 const PageOptions& options = {},
                                 const DrawObserver& observer = {});

/// Writes the page of a sweep that was merged, as `kPageFile` into `folder`.
Result<WrittenPages> write_merged_page(const TuningSource& source,
                                       const std::filesystem::path& folder);

}  // namespace aims
