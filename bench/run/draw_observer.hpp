// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>

namespace aims {

/// Called with each file that is about to be drawn; empty: nobody watches.
using DrawObserver = std::function<void(const std::filesystem::path& file)>;

inline void announce(const DrawObserver& observer, const std::filesystem::path& file) {
  if (observer) observer(file);
}

}  // namespace aims
