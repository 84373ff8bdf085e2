// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <span>

#include "bench/run/draw_observer.hpp"
#include "core/error.hpp"

namespace aims {

/// A picture, or some that are drawn together.
struct Picture {
  std::filesystem::path file;  ///< the first of them
  std::function<Result<void>()> draw;
};

/// Draws the pictures, on two threads when `threads` is more than one: begin with what takes
/// longest. The pixels do not depend on it; `observer` is called by one thread at a time. After an
/// error no other picture is begun; returns that of the first in the list.
Result<void> draw_all(std::span<const Picture> pictures, int threads, const DrawObserver& observer);

}  // namespace aims
