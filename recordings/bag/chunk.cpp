// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/bag/chunk.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace aims {

std::uint64_t ChunkPlace::memory() const {
  return size + (compression == BagCompression::kNone ? 0 : packed_size);
}

Result<void> unpack_chunk(const BagFile& file, const ChunkPlace& place, ChunkContent& content) {
  const bool packed = place.compression != BagCompression::kNone;
  std::vector<std::byte>& raw = packed ? content.packed : content.bytes;
  raw.resize(place.packed_size);
  if (auto got = file.read(place.data_position, raw); !got || !packed) return got;
  const auto unpacked = decompress(place.compression, raw, place.size, content.bytes);
  if (!unpacked) return file.refuse(place.position, "in this chunk: " + unpacked.error().message);
  return {};
}

tl::unexpected<Error> refuse_in_chunk(const BagFile& file, const ChunkPlace& place,
                                      std::size_t offset, const std::string& what) {
  return file.refuse(place.position,
                     fmt::format("in this chunk, at byte {} of its content: {}", offset, what));
}

void count_messages(const ChunkContent& content, ChunkPlace& place) {
  place.counts.clear();
  for (const ChunkMessage& message : content.messages) {
    const bool first = place.counts.empty();
    place.start = first ? message.time : std::min(place.start, message.time);
    place.end = first ? message.time : std::max(place.end, message.time);
    ++place.counts[message.connection];
  }
}

}  // namespace aims
