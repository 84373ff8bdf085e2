// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "core/error.hpp"

namespace aims {

/// Software OpenGL context without a display (OSMesa). Current in the thread that made it until it
/// is destroyed; one at a time per thread. The environment variable LP_NUM_THREADS limits the
/// threads that Mesa draws with; the pixels do not depend on it.
class OffscreenContext {
 public:
  /// Error when Mesa cannot make the context.
  static Result<OffscreenContext> create();
  OffscreenContext(OffscreenContext&&) noexcept;
  OffscreenContext& operator=(OffscreenContext&&) noexcept;
  ~OffscreenContext();

 private:
  struct Impl;
  explicit OffscreenContext(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace aims
