// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/bag/bag_publisher.hpp"

#include <algorithm>
#include <utility>

#include "recordings/bag/bag_records.hpp"

namespace aims {
namespace {

std::vector<std::byte> file_header(std::uint64_t index_position, const BagIndexBytes& index) {
  std::vector<std::byte> bytes;
  HeaderBuilder(bytes)
      .number("chunk_count", index.chunk_count)
      .number("conn_count", index.connection_count)
      .number("index_pos", index_position)
      .op(BagOp::kFileHeader)
      .finish();
  return bytes;
}

/// Position of the first chunk.
constexpr std::uint64_t kFirstChunk =
    kBagMagic.size() + 2 * sizeof(std::uint32_t) + kFileHeaderSize;

}  // namespace

std::vector<std::byte> BagPublisher::empty_bag() {
  const auto magic = bytes_of(kBagMagic);
  std::vector<std::byte> bytes(magic.begin(), magic.end());
  bytes.reserve(kFirstChunk);
  const auto header = file_header(kFirstChunk, {});
  append(bytes, header);
  const std::size_t fields = header.size() - sizeof(std::uint32_t);
  append_data(bytes, std::vector<std::byte>(kFileHeaderSize - fields, std::byte{' '}));
  return bytes;
}

BagPublisher::BagPublisher(std::unique_ptr<BagOutput> output, std::uint64_t reserve)
    : output_(std::move(output)),
      reserve_(reserve),
      end_(kFirstChunk),
      index_position_(kFirstChunk) {}

std::uint64_t BagPublisher::clear_of_index(std::uint64_t wanted, std::uint64_t size) const {
  const std::uint64_t end = index_position_ + published_.size();
  const bool touches = wanted < end && wanted + size > index_position_;
  return touches ? end : wanted;
}

Result<void> BagPublisher::publish(std::uint64_t position, const BagIndexBytes& index) {
  std::vector<std::byte> bytes = index.connections;
  append(bytes, index.chunk_infos);
  if (auto written = output_->write_at(position, bytes); !written) return written;
  const auto header = file_header(position, index);
  if (auto written = output_->write_at(kBagMagic.size(), header); !written) return written;
  index_position_ = position;
  if (&index != &published_) published_ = index;
  return {};
}

Result<void> BagPublisher::make_room(std::uint64_t size) {
  if (published_.size() == 0 || end_ + size <= index_position_) return {};
  return publish(clear_of_index(end_ + size, published_.size()), published_);
}

Result<void> BagPublisher::add_chunk(std::span<const std::byte> chunk, const BagIndexBytes& index) {
  if (auto made = make_room(chunk.size()); !made) return made;
  if (auto written = output_->write_at(end_, chunk); !written) return written;
  const std::uint64_t end = end_ + chunk.size();
  auto published = publish(clear_of_index(end + reserve_, index.size()), index);
  if (published) end_ = end;
  return published;
}

Result<void> BagPublisher::finish(const BagIndexBytes& index) {
  if (auto made = make_room(index.size()); !made) return made;
  if (auto published = publish(end_, index); !published) return published;
  if (auto cut = output_->truncate(end_ + index.size()); !cut) return cut;
  return output_->close();
}

}  // namespace aims
