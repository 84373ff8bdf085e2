// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/rosbag2/rosbag2_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>
#include <system_error>
#include <tuple>
#include <utility>

#include "core/files/byte_cursor.hpp"
#include "recordings/bag/bag_file.hpp"
#include "recordings/mcap/mcap_reader.hpp"
#include "recordings/rosbag2/db3_reader.hpp"
#include "recordings/rosbag2/rosbag2_metadata.hpp"
#include "recordings/rosbag2/zstd_frame.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

/// One file of a recording.
struct Part {
  std::unique_ptr<MessageSource> source;
  std::vector<std::uint32_t> places;  ///< of its connections, in their order, in the recording
  std::optional<BagMessage> waiting;  ///< its next message
  bool ended = false;
};

template <class Reader>
Result<std::unique_ptr<MessageSource>> opened_part(const fs::path& file, BagOpenOptions options) {
  auto reader = Reader::open(file, options);
  if (!reader) return tl::unexpected(reader.error());
  return std::make_unique<Reader>(std::move(*reader));
}

/// Opens a file by its first bytes.
Result<std::unique_ptr<MessageSource>> open_part(const fs::path& file, BagOpenOptions options) {
  const auto opened = BagFile::open(file);
  if (!opened) return tl::unexpected(opened.error());
  std::vector<std::byte> start(std::min<std::uint64_t>(opened->size(), 16));
  if (auto got = opened->read(0, start); !got) return tl::unexpected(got.error());
  if (is_zstd_frame(start)) {
    const auto unpacked = UnpackedFile::create(file);
    if (!unpacked) return tl::unexpected(unpacked.error());
    return open_part(unpacked->path(), options);
  }
  const std::string_view text = as_text(start);
  if (text.starts_with("\x89MCAP")) return opened_part<McapReader>(file, options);
  if (text.starts_with("SQLite format 3")) return opened_part<Db3Reader>(file, options);
  return opened->refuse(0, "expected a file of rosbag2: SQLite ('SQLite format 3') or MCAP");
}

/// The files to read.
Result<Rosbag2Metadata> files_of(const fs::path& recording, bool recover) {
  std::error_code ignored;
  if (!fs::is_directory(recording, ignored)) return Rosbag2Metadata{{recording}, false};
  if (fs::exists(recording / kRosbag2Metadata, ignored)) {
    auto metadata = read_rosbag2_metadata(recording);
    // A power failure may leave it empty or in parts.
    Rosbag2Metadata found{rosbag2_files(recording), false};
    if (!metadata && recover && !found.files.empty()) return found;
    return metadata;
  }
  Rosbag2Metadata found{rosbag2_files(recording), false};
  if (found.files.empty()) {
    return failure(
        fmt::format("{}: it is a directory, expected a recording: a file, or a folder "
                    "of rosbag2 with {}",
                    recording.string(), kRosbag2Metadata));
  }
  if (recover) return found;
  return failure(
      fmt::format("{}: has no {}: recording was never completed; --recover reads the "
                  "intact files, `ros2 bag reindex` writes it",
                  recording.string(), kRosbag2Metadata));
}

/// Joins the connections of the files: a topic of one type is one.
class Joiner {
 public:
  void add(Part& part, std::vector<BagConnection>& all) {
    for (const BagConnection& each : part.source->connections()) {
      const auto key = std::tuple(each.topic, each.type, each.definition, each.format.serialization,
                                  each.latching);
      const auto id = static_cast<std::uint32_t>(all.size());
      const auto [known, added] = places_.emplace(key, id);
      part.places.resize(std::max<std::size_t>(part.places.size(), each.id + 1));
      part.places[each.id] = known->second;
      if (added) {
        all.push_back(each);
        all.back().id = id;
      } else {
        all[known->second].messages += each.messages;
      }
    }
  }

 private:
  std::map<std::tuple<std::string, std::string, std::string, Serialization, bool>, std::uint32_t>
      places_;
};

void add_summary(const BagSummary& part, BagSummary& all, std::set<std::string>& compressions) {
  ++all.chunks;
  all.file_size += part.file_size;
  all.lost_bytes += part.lost_bytes;
  all.indexed = all.indexed && part.indexed;
  all.closed = all.closed && part.closed;
  all.lost_messages += part.lost_messages;
  compressions.insert(part.compression);
  if (part.messages == 0) return;
  all.start = all.messages == 0 ? part.start : std::min(all.start, part.start);
  all.end = all.messages == 0 ? part.end : std::max(all.end, part.end);
  all.messages += part.messages;
}

}  // namespace

struct Rosbag2Reader::Impl {
  fs::path recording;
  std::size_t memory_limit = 0;
  std::vector<Part> parts = {};
  std::vector<BagConnection> connections = {};
  BagSummary summary = {};
  Part* lent = nullptr;                  ///< whose message the caller has
  std::vector<std::byte> unpacked = {};  ///< of that message, if it was compressed

  Result<void> open(const Rosbag2Metadata& metadata, BagOpenOptions options);
  /// Fetches the next message of each part that may be the next of all; returns the earliest.
  Result<Part*> earliest();
  Result<BagMessage> lend(Part& part);
};

Result<void> Rosbag2Reader::Impl::open(const Rosbag2Metadata& metadata, BagOpenOptions options) {
  Joiner joiner;
  std::set<std::string> compressions;
  std::optional<Error> broken;
  for (const fs::path& file : metadata.files) {
    auto source = open_part(file, options);
    if (!source && !options.recover) return tl::unexpected(source.error());
    std::error_code ignored;
    if (!source) {
      broken = source.error();
      summary.lost_bytes += fs::file_size(file, ignored);
      continue;
    }
    Part part;
    part.source = std::move(*source);
    joiner.add(part, connections);
    add_summary(part.source->summary(), summary, compressions);
    parts.push_back(std::move(part));
  }
  if (parts.empty()) return tl::unexpected(*broken);
  if (metadata.compressed) compressions = {"zstd"};
  summary.compression = fmt::format("{}", fmt::join(compressions, ", "));
  return {};
}

Result<Part*> Rosbag2Reader::Impl::earliest() {
  Part* first = nullptr;
  for (Part& part : parts) {
    // A part that begins later is not touched yet: it may need much memory.
    const bool later =
        first != nullptr && first->waiting->record_time <= part.source->summary().start;
    if (!part.waiting && !part.ended && !later) {
      auto message = part.source->next();
      if (!message) return tl::unexpected(message.error());
      part.waiting = *message;
      part.ended = !part.waiting;
    }
    if (!part.waiting) continue;
    if (first == nullptr || part.waiting->record_time < first->waiting->record_time) first = &part;
  }
  return first;
}

Result<BagMessage> Rosbag2Reader::Impl::lend(Part& part) {
  lent = &part;
  BagMessage message = *part.waiting;
  message.connection = &connections[part.places[message.connection->id]];
  const bool cdr = message.connection->format.serialization == Serialization::kCdr;
  if (!cdr || !is_zstd_frame(message.data)) return message;
  if (auto ok = unpack_frame(message.data, memory_limit, unpacked); !ok) {
    return failure(fmt::format("{}: topic '{}', at {} ns: {}", part.source->name(),
                               message.connection->topic, message.record_time, ok.error().message));
  }
  message.data = unpacked;
  return message;
}

Rosbag2Reader::Rosbag2Reader(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Rosbag2Reader::Rosbag2Reader(Rosbag2Reader&&) noexcept = default;
Rosbag2Reader& Rosbag2Reader::operator=(Rosbag2Reader&&) noexcept = default;
Rosbag2Reader::~Rosbag2Reader() = default;

Result<Rosbag2Reader> Rosbag2Reader::open(const fs::path& recording, BagOpenOptions options) {
  const auto metadata = files_of(recording, options.recover);
  if (!metadata) return tl::unexpected(metadata.error());
  auto impl = std::unique_ptr<Impl>(new Impl{recording, options.memory_limit});
  if (auto ok = impl->open(*metadata, options); !ok) return tl::unexpected(ok.error());
  return Rosbag2Reader(std::move(impl));
}

std::string Rosbag2Reader::name() const { return impl_->recording.string(); }

const std::vector<BagConnection>& Rosbag2Reader::connections() const { return impl_->connections; }

const BagSummary& Rosbag2Reader::summary() const { return impl_->summary; }

void Rosbag2Reader::select(std::span<const std::string> topics) {
  for (Part& part : impl_->parts) {
    part.source->select(topics);
    const bool chosen =
        part.waiting && std::ranges::find(topics, part.waiting->connection->topic) != topics.end();
    if (!chosen && &part != impl_->lent) part.waiting.reset();
  }
}

Result<std::optional<BagMessage>> Rosbag2Reader::next() {
  Impl& rosbag = *impl_;
  if (rosbag.lent != nullptr) std::exchange(rosbag.lent, nullptr)->waiting.reset();
  const auto part = rosbag.earliest();
  if (!part) return tl::unexpected(part.error());
  if (*part == nullptr) return std::optional<BagMessage>();
  auto message = rosbag.lend(**part);
  if (!message) return tl::unexpected(message.error());
  return std::optional<BagMessage>(*message);
}

void Rosbag2Reader::rewind() {
  impl_->lent = nullptr;
  for (Part& part : impl_->parts) {
    part.waiting.reset();
    part.ended = false;
    part.source->rewind();
  }
}

}  // namespace aims
