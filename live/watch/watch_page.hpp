// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

namespace aims {

/// The page of `aims watch`; empty where it was built without npm.
std::string_view watch_page();

}  // namespace aims
