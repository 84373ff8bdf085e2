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

/// The index of a bag as in the file: connection records, then chunk infos.
struct BagIndexBytes {
  std::vector<std::byte> connections;
  std::vector<std::byte> chunk_infos;
  std::uint32_t connection_count = 0;
  std::uint32_t chunk_count = 0;

  std::uint64_t size() const { return connections.size() + chunk_infos.size(); }
};

/// Adds chunks to a bag so that at every instant the file header points at a complete index of
/// complete chunks. The current index is never overwritten: the next chunk goes before it, into
/// reserved space, and the next index to another place. Only then is the header, a few bytes inside
/// one page, redirected.
class BagPublisher {
 public:
  /// The bytes of a bag without chunks, with which `output` begins.
  static std::vector<std::byte> empty_bag();

  /// `reserve`: bytes left free before a published index for the next chunk.
  BagPublisher(std::unique_ptr<BagOutput> output, std::uint64_t reserve);

  /// Position of the next chunk.
  std::uint64_t chunk_position() const { return end_; }
  /// Adds a chunk, with its index records, at `chunk_position()`; `index` contains it already.
  Result<void> add_chunk(std::span<const std::byte> chunk, const BagIndexBytes& index);
  /// Moves the index right behind the last chunk, cuts the file there and closes it.
  Result<void> finish(const BagIndexBytes& index);

 private:
  Result<void> publish(std::uint64_t position, const BagIndexBytes& index);
  Result<void> make_room(std::uint64_t size);
  /// The first position from `wanted` on at which `size` bytes do not overlap the current index.
  std::uint64_t clear_of_index(std::uint64_t wanted, std::uint64_t size) const;

  std::unique_ptr<BagOutput> output_;
  std::uint64_t reserve_;
  std::uint64_t end_;             ///< of the last chunk
  std::uint64_t index_position_;  ///< of the current index
  BagIndexBytes published_;
};

}  // namespace aims
