// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/rosbag2/zstd_frame.hpp"

#include <fmt/format.h>
#include <zstd.h>

#include <algorithm>
#include <memory>

#include "core/files/byte_cursor.hpp"
#include "recordings/bag/bag_file.hpp"
#include "recordings/bag/compression.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kBlock = std::size_t{1} << 20;

/// The size that a frame states, from its first bytes.
Result<std::uint64_t> stated_size(std::span<const std::byte> start) {
  const unsigned long long size = ZSTD_getFrameContentSize(start.data(), start.size());
  if (size == ZSTD_CONTENTSIZE_ERROR || size == ZSTD_CONTENTSIZE_UNKNOWN) {
    return failure("expected a frame of zstd that states its size");
  }
  return static_cast<std::uint64_t>(size);
}

/// Unpacks a file block by block.
class FileUnpacker {
 public:
  FileUnpacker(const BagFile& packed, TemporaryFile& output)
      : packed_(packed), output_(output), stream_(ZSTD_createDCtx(), &ZSTD_freeDCtx) {}

  Result<void> unpack(std::uint64_t size) {
    std::vector<std::byte> in(kBlock);
    std::size_t hint = 1;
    for (std::uint64_t position = 0; position < packed_.size() && hint != 0;) {
      const auto count = std::min<std::uint64_t>(kBlock, packed_.size() - position);
      const auto block = std::span(in).first(count);
      if (auto got = packed_.read(position, block); !got) return got;
      if (auto written = unpack_block(block, size, hint); !written) {
        return packed_.refuse(position, written.error().message);
      }
      position += count;
    }
    if (hint == 0 && written_ == size) return {};
    return packed_.refuse(packed_.size(), "zstd: the frame ends early");
  }

 private:
  Result<void> unpack_block(std::span<const std::byte> block, std::uint64_t size,
                            std::size_t& hint) {
    ZSTD_inBuffer input = {block.data(), block.size(), 0};
    bool filled = true;
    while (hint != 0 && (input.pos < input.size || filled)) {
      ZSTD_outBuffer output = {out_.data(), out_.size(), 0};
      hint = ZSTD_decompressStream(stream_.get(), &output, &input);
      if (ZSTD_isError(hint)) return failure(fmt::format("zstd: {}", ZSTD_getErrorName(hint)));
      if (output.pos > size - written_) return failure("zstd: expected as many bytes as stated");
      const auto bytes = std::span(out_).first(output.pos);
      if (auto ok = output_.write_at(written_, bytes); !ok) return ok;
      written_ += output.pos;
      filled = output.pos == output.size;
    }
    if (input.pos < input.size) return failure("zstd: bytes behind the frame");
    return {};
  }

  const BagFile& packed_;
  TemporaryFile& output_;
  std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)> stream_;
  std::vector<std::byte> out_ = std::vector<std::byte>(kBlock);
  std::uint64_t written_ = 0;
};

Result<std::uint64_t> size_when_unpacked(const BagFile& packed) {
  std::vector<std::byte> start(std::min<std::uint64_t>(packed.size(), 32));
  if (auto got = packed.read(0, start); !got) return tl::unexpected(got.error());
  const auto size = stated_size(start);
  if (!size) return packed.refuse(0, size.error().message);
  return size;
}

}  // namespace

bool is_zstd_frame(std::span<const std::byte> bytes) {
  return bytes.size() >= 4 && load_number<std::uint32_t>(bytes.data()) == ZSTD_MAGICNUMBER;
}

Result<void> unpack_frame(std::span<const std::byte> frame, std::size_t limit,
                          std::vector<std::byte>& out) {
  const auto size = stated_size(frame);
  if (!size) return tl::unexpected(size.error());
  if (*size > limit) {
    return failure(
        fmt::format("this message needs {} bytes of memory, more than {}", *size, limit));
  }
  return decompress(BagCompression::kZstd, frame, *size, out);
}

Result<TemporaryFile> unpack_file(const fs::path& packed) {
  const auto file = BagFile::open(packed);
  if (!file) return tl::unexpected(file.error());
  const auto size = size_when_unpacked(*file);
  if (!size) return tl::unexpected(size.error());
  const auto refuse = [&](const Error& error) {
    return failure(fmt::format("{}: {}", packed.string(), error.message));
  };
  auto output = TemporaryFile::create(packed.stem().string(), *size);
  if (!output) return refuse(output.error());
  if (auto ok = FileUnpacker(*file, *output).unpack(*size); !ok) return tl::unexpected(ok.error());
  if (auto ok = output->publish(); !ok) return refuse(ok.error());
  return output;
}

}  // namespace aims
