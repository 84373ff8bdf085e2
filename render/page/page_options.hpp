// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace aims {

/// What a page shows besides its own folder.
struct PageOptions {
  std::filesystem::path against;     ///< results to hold a suite against; empty: none
  std::filesystem::path detectors;   ///< folder of `aims detectors`; empty: the suite's own, if any
  std::filesystem::path out_folder;  ///< where the page will lie: links are relative to it
};

}  // namespace aims
