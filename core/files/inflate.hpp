// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/error.hpp"

namespace aims {

/// Unpacks a stream of zlib or gzip (RFC 1950, 1952) or bare deflate (RFC 1951) to at most `limit`
/// bytes. Error for bytes that are no such stream, are damaged, end early, or unpack to more.
Result<std::vector<std::byte>> inflate(std::span<const std::byte> packed, std::size_t limit);

}  // namespace aims
