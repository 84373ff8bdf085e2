// SPDX-License-Identifier: BSD-3-Clause
#include "core/files/inflate.hpp"

#define ZLIB_CONST
#include <zlib.h>

#include <algorithm>
#include <limits>
#include <memory>

namespace aims {
namespace {

// Formats as zlib numbers them, with a window of up to 32 kB.
constexpr int kBareDeflate = -15;
constexpr int kZlibOrGzip = 15 + 32;

constexpr std::size_t kBlock = std::size_t{1} << 16;  ///< by which the output grows [bytes]

/// Whether the bytes begin as zlib or gzip do.
bool has_header(std::span<const std::byte> bytes) {
  if (bytes.size() < 2) return false;
  const int first = std::to_integer<int>(bytes[0]), second = std::to_integer<int>(bytes[1]);
  const bool gzip = first == 0x1f && second == 0x8b;
  return gzip || (first % 16 == Z_DEFLATED && (256 * first + second) % 31 == 0);
}

}  // namespace

Result<std::vector<std::byte>> inflate(std::span<const std::byte> packed, std::size_t limit) {
  if (packed.size() > std::numeric_limits<uInt>::max()) {
    return failure("expected at most 4 GiB of compressed data");
  }
  z_stream state{};
  if (inflateInit2(&state, has_header(packed) ? kZlibOrGzip : kBareDeflate) != Z_OK) {
    return failure("no memory to unpack compressed data");
  }
  const std::unique_ptr<z_stream, decltype(&inflateEnd)> end(&state, &inflateEnd);
  state.next_in = reinterpret_cast<const Bytef*>(packed.data());
  state.avail_in = static_cast<uInt>(packed.size());
  std::vector<std::byte> out;
  int status = Z_OK;
  while (status == Z_OK && out.size() <= limit) {
    const std::size_t used = out.size();
    out.resize(std::min(used + kBlock, limit + 1));
    state.next_out = reinterpret_cast<Bytef*>(out.data() + used);
    state.avail_out = static_cast<uInt>(out.size() - used);
    status = ::inflate(&state, Z_NO_FLUSH);
    out.resize(out.size() - state.avail_out);
  }
  if (out.size() > limit) return failure("unpacks to more than expected");
  if (status == Z_STREAM_END) return out;
  return failure(status == Z_BUF_ERROR ? "ends within compressed data"
                                       : "no sound compressed data");
}

}  // namespace aims
