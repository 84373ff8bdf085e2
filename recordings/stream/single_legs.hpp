// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>

#include "recordings/bag/message_source.hpp"

namespace aims {

/// Of topics or messages that hold one leg each, which are not joined: which they are, and what is
/// expected instead; empty without such.
std::string single_legs_text(std::span<const BagConnection> connections);

}  // namespace aims
