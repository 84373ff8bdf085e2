// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/error.hpp"
#include "live/live_config.hpp"
#include "live/transport.hpp"

namespace aims {

/// Gathers topics, decides how to read them, then estimates and publishes until the node is asked
/// to end; anew when clocks jump, or on request. Error for what cannot be read or written.
Result<void> run_live(Transport& transport, const LiveOptions& options);

}  // namespace aims
