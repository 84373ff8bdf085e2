// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/bag/chunk_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>
#include <tuple>
#include <utility>

namespace aims {
namespace {

/// Sort key of the reading order.
struct MessageKey {
  Time time = 0;
  std::uint64_t chunk = 0;   ///< position in the file
  std::uint32_t offset = 0;  ///< in the chunk

  bool operator<(const MessageKey& other) const {
    return std::tie(time, chunk, offset) < std::tie(other.time, other.chunk, other.offset);
  }
};

/// A chunk in memory, its messages in order of reading.
struct LoadedChunk {
  const ChunkPlace* place = nullptr;
  ChunkContent content;
  std::size_t next = 0;

  std::uint64_t memory() const {
    return place->memory() + content.messages.size() * sizeof(ChunkMessage);
  }
  MessageKey key() const {
    const ChunkMessage& message = content.messages[next];
    return {message.time, place->position, message.offset};
  }
};

/// Heap order: the chunk with the earliest message on top.
bool later(const std::unique_ptr<LoadedChunk>& a, const std::unique_ptr<LoadedChunk>& b) {
  return b->key() < a->key();
}

}  // namespace

struct ChunkReader::Impl {
  std::unique_ptr<ChunkContainer> container;
  std::vector<BagConnection> connections;
  BagSummary summary;
  std::size_t memory_limit = 0;
  std::map<std::uint32_t, const BagConnection*> chosen = {};  ///< by id
  std::vector<const ChunkPlace*> pending = {};                ///< latest start first
  std::vector<std::unique_ptr<LoadedChunk>> loaded = {};
  std::vector<std::unique_ptr<LoadedChunk>> spare = {};  ///< buffers for reuse
  std::uint64_t memory = 0;                              ///< of the loaded chunks [bytes]
  std::optional<MessageKey> last = std::nullopt;         ///< returned
  bool lent = false;                                     ///< the caller holds the message on top

  void prepare();
  void release(std::unique_ptr<LoadedChunk> chunk);
  void step();
  Result<void> load(const ChunkPlace& place);
  bool wanted(const ChunkPlace& place) const;
};

bool ChunkReader::Impl::wanted(const ChunkPlace& place) const {
  if (last && place.end < last->time) return false;
  return place.counts.empty() ||
         std::any_of(place.counts.begin(), place.counts.end(),
                     [this](const auto& each) { return chosen.contains(each.first); });
}

/// Lists the chunks that are still to be read from the current position.
void ChunkReader::Impl::prepare() {
  for (auto& chunk : loaded) release(std::move(chunk));
  loaded.clear();
  lent = false;
  pending.clear();
  for (const ChunkPlace& chunk : container->chunks()) {
    if (wanted(chunk)) pending.push_back(&chunk);
  }
  std::stable_sort(pending.begin(), pending.end(), [](const ChunkPlace* a, const ChunkPlace* b) {
    return std::tie(a->start, a->position) > std::tie(b->start, b->position);
  });
}

void ChunkReader::Impl::release(std::unique_ptr<LoadedChunk> chunk) {
  constexpr std::size_t kMaxSpareBytes = std::size_t{16} << 20;
  memory -= chunk->memory();
  const std::size_t kept = chunk->content.bytes.capacity() + chunk->content.packed.capacity();
  if (spare.size() < 2 && kept <= kMaxSpareBytes) spare.push_back(std::move(chunk));
}

/// Drops the message that was lent to the caller.
void ChunkReader::Impl::step() {
  if (!lent) return;
  lent = false;
  std::pop_heap(loaded.begin(), loaded.end(), later);
  if (++loaded.back()->next < loaded.back()->content.messages.size()) {
    std::push_heap(loaded.begin(), loaded.end(), later);
    return;
  }
  release(std::move(loaded.back()));
  loaded.pop_back();
}

Result<void> ChunkReader::Impl::load(const ChunkPlace& place) {
  const BagFile& file = container->file();
  if (place.memory() > memory_limit) {
    return file.refuse(place.position,
                       fmt::format("this chunk needs {} bytes of memory, more than {}; {}",
                                   place.memory(), memory_limit, container->remedy()));
  }
  if (memory + place.memory() > memory_limit) {
    return file.refuse(place.position,
                       fmt::format("{} chunks overlap in time and need more than {} bytes; {}",
                                   loaded.size() + 1, memory_limit, container->remedy()));
  }
  std::unique_ptr<LoadedChunk> chunk;
  if (spare.empty()) {
    chunk = std::make_unique<LoadedChunk>();
  } else {
    chunk = std::move(spare.back());
    spare.pop_back();
  }
  chunk->place = &place;
  chunk->next = 0;
  ChunkContent& content = chunk->content;
  if (auto got = container->load(place, content); !got) return got;
  std::erase_if(content.messages, [&](const ChunkMessage& message) {
    const MessageKey key{message.time, place.position, message.offset};
    return !chosen.contains(message.connection) || (last && !(*last < key));
  });
  std::stable_sort(content.messages.begin(), content.messages.end(),
                   [](const ChunkMessage& a, const ChunkMessage& b) { return a.time < b.time; });
  if (content.messages.empty()) return {};
  memory += chunk->memory();
  loaded.push_back(std::move(chunk));
  std::push_heap(loaded.begin(), loaded.end(), later);
  return {};
}

ChunkReader::ChunkReader(std::unique_ptr<ChunkContainer> container,
                         std::vector<BagConnection> connections, BagSummary summary,
                         std::size_t memory_limit)
    : impl_(new Impl{std::move(container), std::move(connections), std::move(summary),
                     memory_limit}) {
  for (const BagConnection& each : impl_->connections) impl_->chosen[each.id] = &each;
  impl_->prepare();
}

ChunkReader::ChunkReader(ChunkReader&&) noexcept = default;
ChunkReader& ChunkReader::operator=(ChunkReader&&) noexcept = default;
ChunkReader::~ChunkReader() = default;

const std::filesystem::path& ChunkReader::file() const { return impl_->container->file().path(); }

const std::vector<BagConnection>& ChunkReader::connections() const { return impl_->connections; }

const BagSummary& ChunkReader::summary() const { return impl_->summary; }

void ChunkReader::select(std::span<const std::string> topics) {
  impl_->chosen.clear();
  for (const BagConnection& each : impl_->connections) {
    if (std::find(topics.begin(), topics.end(), each.topic) != topics.end()) {
      impl_->chosen[each.id] = &each;
    }
  }
  impl_->prepare();
}

Result<std::optional<BagMessage>> ChunkReader::next() {
  Impl& bag = *impl_;
  bag.step();
  while (!bag.pending.empty() &&
         (bag.loaded.empty() || bag.pending.back()->start <= bag.loaded.front()->key().time)) {
    const ChunkPlace& place = *bag.pending.back();
    if (const auto got = bag.load(place); !got) return tl::unexpected(got.error());
    bag.pending.pop_back();
  }
  if (bag.loaded.empty()) return std::optional<BagMessage>();
  const LoadedChunk& top = *bag.loaded.front();
  const ChunkMessage& message = top.content.messages[top.next];
  bag.lent = true;
  bag.last = top.key();
  const std::span<const std::byte> bytes = top.content.bytes;
  return BagMessage{bag.chosen.at(message.connection), message.time,
                    bytes.subspan(message.data_offset, message.data_size), top.place->position};
}

void ChunkReader::rewind() {
  impl_->last.reset();
  impl_->prepare();
}

BagSummary summarize(const BagFile& file, std::span<const ChunkPlace> chunks) {
  BagSummary summary;
  summary.file_size = file.size();
  summary.chunks = chunks.size();
  std::set<std::string_view> compressions;
  bool first = true;
  for (const ChunkPlace& chunk : chunks) {
    summary.start = first ? chunk.start : std::min(summary.start, chunk.start);
    summary.end = first ? chunk.end : std::max(summary.end, chunk.end);
    first = false;
    for (const auto& [id, count] : chunk.counts) summary.messages += count;
    compressions.insert(name_of(chunk.compression));
  }
  summary.compression = fmt::format("{}", fmt::join(compressions, ", "));
  return summary;
}

}  // namespace aims
