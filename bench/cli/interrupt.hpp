// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace aims {

/// From now on Ctrl-C is noted; a second Ctrl-C ends the program at once.
void watch_interrupt();

/// True after Ctrl-C.
bool interrupted();

}  // namespace aims
