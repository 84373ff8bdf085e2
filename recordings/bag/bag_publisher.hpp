// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/error.hpp"
#include "recordings/bag/bag_output.hpp"

namespace aims {

/// The index of a bag as it lies in the file: connection records, then chunk infos.
struct BagIndexBytes {
  std::vector<std::byte> connections;
  std::vector<std::byte> chunk_infos;
  std::uint32_t connection_count = 0;
  std::uint32_t chunk_count = 0;

  std::uint64_t size() const { return connections.size() + chunk_infos.size(); }
};

/// Puts chunks into a bag so that at every instant the file header points at an index that is whole
/// and tells of chunks that are whole. The index that counts is never written over: the next chunk
/// goes before it, where there is room, and the next index to another place; only then the header,
/// a few bytes inside one page, is turned to the new one.
class BagPublisher {
 public:
  /// What a bag without chunks is: the bytes that `output` begins with.
  static std::vector<std::byte> empty_bag();

  /// `room`: bytes left free before a published index for the chunk to come.
  BagPublisher(std::unique_ptr<BagOutput> output, std::uint64_t room);

  /// Where the next chunk will lie.
  std::uint64_t chunk_position() const { return end_; }
  /// Adds a chunk, with its index records, at `chunk_position()`; `index` tells of it already.
  Result<void> add_chunk(std::span<const std::byte> chunk, const BagIndexBytes& index);
  /// Moves the index right behind the last chunk, cuts the file there and closes it.
  Result<void> finish(const BagIndexBytes& index);

 private:
  Result<void> publish(std::uint64_t position, const BagIndexBytes& index);
  Result<void> make_room(std::uint64_t size);
  /// A place from `wished` on that does not touch the index that counts.
  std::uint64_t beside_index(std::uint64_t wished, std::uint64_t size) const;

  std::unique_ptr<BagOutput> output_;
  std::uint64_t room_;
  std::uint64_t end_;             ///< of the last chunk
  std::uint64_t index_position_;  ///< of the index that counts
  BagIndexBytes published_;
};

}  // namespace aims
