// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/bag/compression.hpp"

#include <bzlib.h>
#include <fmt/format.h>
#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <limits>
#include <memory>

namespace aims {
namespace {

constexpr std::array<std::string_view, 4> kNames = {"none", "lz4", "bz2", "zstd"};
constexpr int kBz2BlockSize = 9;  ///< in 100 kB, as rosbag uses
constexpr std::size_t kFirstCapacity = std::size_t{64} << 10;

Result<std::vector<std::byte>> compress_lz4(std::span<const std::byte> bytes) {
  LZ4F_preferences_t preferences{};
  preferences.frameInfo.blockSizeID = LZ4F_max4MB;
  // rosbag's own reader accepts nothing else.
  preferences.frameInfo.blockMode = LZ4F_blockIndependent;
  preferences.frameInfo.contentChecksumFlag = LZ4F_contentChecksumEnabled;
  std::vector<std::byte> out(LZ4F_compressFrameBound(bytes.size(), &preferences));
  const std::size_t size =
      LZ4F_compressFrame(out.data(), out.size(), bytes.data(), bytes.size(), &preferences);
  if (LZ4F_isError(size)) return failure(fmt::format("lz4: {}", LZ4F_getErrorName(size)));
  out.resize(size);
  return out;
}

Result<std::vector<std::byte>> compress_bz2(std::span<const std::byte> bytes) {
  // The bound that the manual of bzip2 gives.
  std::vector<std::byte> out(bytes.size() + bytes.size() / 100 + 600);
  auto size = static_cast<unsigned>(out.size());
  // The library does not write to its source; its interface is older than const.
  auto* source = reinterpret_cast<char*>(const_cast<std::byte*>(bytes.data()));
  const int outcome =
      BZ2_bzBuffToBuffCompress(reinterpret_cast<char*>(out.data()), &size, source,
                               static_cast<unsigned>(bytes.size()), kBz2BlockSize, 0, 0);
  if (outcome != BZ_OK) return failure(fmt::format("bz2: error {}", outcome));
  out.resize(size);
  return out;
}

Result<std::vector<std::byte>> compress_zstd(std::span<const std::byte> bytes) {
  std::vector<std::byte> out(ZSTD_compressBound(bytes.size()));
  const std::size_t size =
      ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), ZSTD_CLEVEL_DEFAULT);
  if (ZSTD_isError(size)) return failure(fmt::format("zstd: {}", ZSTD_getErrorName(size)));
  out.resize(size);
  return out;
}

tl::unexpected<Error> wrong_size(std::size_t size, const char* found) {
  return failure(fmt::format("expected {} bytes when unpacked, found {}", size, found));
}

/// Enlarges `out`, of which `filled` bytes are used, up to `size`.
void grow(std::vector<std::byte>& out, std::size_t filled, std::size_t size, std::size_t packed) {
  if (filled < out.size()) return;
  const std::size_t wanted = std::max({2 * out.size(), 4 * packed, kFirstCapacity});
  out.resize(std::min(wanted, size));
}

Result<void> decompress_lz4(std::span<const std::byte> packed, std::size_t size,
                            std::vector<std::byte>& out) {
  LZ4F_dctx* raw = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&raw, LZ4F_VERSION))) {
    return failure("lz4: no memory");
  }
  const std::unique_ptr<LZ4F_dctx, decltype(&LZ4F_freeDecompressionContext)> context(
      raw, &LZ4F_freeDecompressionContext);
  std::size_t filled = 0;
  while (true) {
    grow(out, filled, size, packed.size());
    // At the stated size one more byte of capacity shows whether the frame holds more.
    std::byte spare{};
    const bool full = filled == size;
    std::size_t room = full ? 1 : out.size() - filled;
    std::size_t taken = packed.size();
    const std::size_t hint = LZ4F_decompress(raw, full ? &spare : out.data() + filled, &room,
                                             packed.data(), &taken, nullptr);
    if (LZ4F_isError(hint)) return failure(fmt::format("lz4: {}", LZ4F_getErrorName(hint)));
    if (full && room > 0) return wrong_size(size, "more");
    packed = packed.subspan(taken);
    filled += room;
    if (hint == 0) break;
    if (taken == 0 && room == 0) return failure("lz4: the frame ends early");
  }
  if (filled < size) return wrong_size(size, fmt::format("{}", filled).c_str());
  if (!packed.empty()) return failure(fmt::format("lz4: {} bytes behind the frame", packed.size()));
  return {};
}

Result<void> decompress_bz2(std::span<const std::byte> packed, std::size_t size,
                            std::vector<std::byte>& out) {
  bz_stream stream{};
  if (BZ2_bzDecompressInit(&stream, 0, 0) != BZ_OK) return failure("bz2: no memory");
  const std::unique_ptr<bz_stream, decltype(&BZ2_bzDecompressEnd)> end(&stream,
                                                                       &BZ2_bzDecompressEnd);
  stream.next_in = reinterpret_cast<char*>(const_cast<std::byte*>(packed.data()));
  stream.avail_in = static_cast<unsigned>(packed.size());
  std::size_t filled = 0;
  int outcome = BZ_OK;
  while (outcome != BZ_STREAM_END) {
    grow(out, filled, size, packed.size());
    std::byte spare{};
    const bool full = filled == size;
    const auto room = static_cast<unsigned>(full ? 1 : out.size() - filled);
    const unsigned before = stream.avail_in;
    stream.next_out = reinterpret_cast<char*>(full ? &spare : out.data() + filled);
    stream.avail_out = room;
    outcome = BZ2_bzDecompress(&stream);
    if (outcome != BZ_OK && outcome != BZ_STREAM_END) {
      return failure(fmt::format("bz2: damaged (error {})", outcome));
    }
    const unsigned given = room - stream.avail_out;
    if (full && given > 0) return wrong_size(size, "more");
    filled += given;
    if (outcome == BZ_OK && given == 0 && before == stream.avail_in) {
      return failure("bz2: the stream ends early");
    }
  }
  if (filled < size) return wrong_size(size, fmt::format("{}", filled).c_str());
  if (stream.avail_in > 0) {
    return failure(fmt::format("bz2: {} bytes behind the stream", stream.avail_in));
  }
  return {};
}

Result<void> decompress_zstd(std::span<const std::byte> packed, std::size_t size,
                             std::vector<std::byte>& out) {
  const std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)> context(ZSTD_createDCtx(),
                                                                     &ZSTD_freeDCtx);
  if (!context) return failure("zstd: no memory");
  ZSTD_inBuffer input = {packed.data(), packed.size(), 0};
  std::size_t filled = 0;
  std::size_t hint = 1;
  while (hint != 0) {
    grow(out, filled, size, packed.size());
    std::byte spare{};
    const bool full = filled == size;
    ZSTD_outBuffer output = {full ? &spare : out.data() + filled, full ? 1 : out.size() - filled,
                             0};
    const std::size_t before = input.pos;
    hint = ZSTD_decompressStream(context.get(), &output, &input);
    if (ZSTD_isError(hint)) return failure(fmt::format("zstd: {}", ZSTD_getErrorName(hint)));
    if (full && output.pos > 0) return wrong_size(size, "more");
    filled += output.pos;
    if (hint != 0 && output.pos == 0 && input.pos == before) {
      return failure("zstd: the frame ends early");
    }
  }
  if (filled < size) return wrong_size(size, fmt::format("{}", filled).c_str());
  if (input.pos < packed.size()) {
    return failure(fmt::format("zstd: {} bytes behind the frame", packed.size() - input.pos));
  }
  return {};
}

}  // namespace

std::string_view name_of(BagCompression compression) {
  return kNames[static_cast<std::size_t>(compression)];
}

std::optional<BagCompression> compression_named(std::string_view name) {
  const auto found = std::find(kNames.begin(), kNames.end(), name);
  if (found == kNames.end()) return std::nullopt;
  return static_cast<BagCompression>(found - kNames.begin());
}

Result<std::vector<std::byte>> compress(BagCompression compression,
                                        std::span<const std::byte> bytes) {
  if (bytes.size() >= std::numeric_limits<std::uint32_t>::max()) {
    return failure(fmt::format("{} bytes are too many for one chunk", bytes.size()));
  }
  if (compression == BagCompression::kLz4) return compress_lz4(bytes);
  if (compression == BagCompression::kBz2) return compress_bz2(bytes);
  if (compression == BagCompression::kZstd) return compress_zstd(bytes);
  return std::vector<std::byte>(bytes.begin(), bytes.end());
}

Result<void> decompress(BagCompression compression, std::span<const std::byte> packed,
                        std::size_t size, std::vector<std::byte>& out) {
  if (compression != BagCompression::kNone) out.resize(std::min(out.size(), size));
  if (compression == BagCompression::kLz4) return decompress_lz4(packed, size, out);
  if (compression == BagCompression::kBz2) return decompress_bz2(packed, size, out);
  if (compression == BagCompression::kZstd) return decompress_zstd(packed, size, out);
  if (packed.size() != size) return wrong_size(size, fmt::format("{}", packed.size()).c_str());
  out.assign(packed.begin(), packed.end());
  return {};
}

}  // namespace aims
