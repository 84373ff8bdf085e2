// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/rosbag2/rosbag2_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <system_error>
#include <utility>

#include "core/files/byte_cursor.hpp"
#include "recordings/bag/bag_file.hpp"
#include "recordings/bag/merged_source.hpp"
#include "recordings/mcap/mcap_reader.hpp"
#include "recordings/rosbag2/db3_reader.hpp"
#include "recordings/rosbag2/rosbag2_metadata.hpp"
#include "recordings/rosbag2/zstd_frame.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

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
    const auto unpacked = unpack_file(file);
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
  const bool helps = std::ranges::any_of(found.files, [](const fs::path& file) {
    const auto part = open_part(file, {.recover = true});
    return part && (*part)->summary().messages > 0;
  });
  return failure(
      fmt::format("{}: has no {}: recording was never completed; {}", recording.string(),
                  kRosbag2Metadata,
                  helps ? "--recover reads the intact files, `ros2 bag reindex` writes it"
                        : "none of its files can be read"),
      helps ? ErrorKind::kRecoverable : ErrorKind::kOther);
}

}  // namespace

struct Rosbag2Reader::Impl {
  std::size_t memory_limit = 0;
  MergedSource files;
  std::vector<std::byte> unpacked = {};  ///< the lent message, if it was compressed

  Result<void> open(const Rosbag2Metadata& metadata, BagOpenOptions options);
  Result<BagMessage> unpack(BagMessage message);
};

Result<void> Rosbag2Reader::Impl::open(const Rosbag2Metadata& metadata, BagOpenOptions options) {
  std::optional<Error> broken;
  for (const fs::path& file : metadata.files) {
    auto source = open_part(file, options);
    if (!source && !options.recover) return tl::unexpected(source.error());
    std::error_code ignored;
    if (!source) {
      broken = source.error();
      files.lose(fs::file_size(file, ignored));
      continue;
    }
    files.add(std::move(*source));
  }
  if (files.empty()) return tl::unexpected(*broken);
  if (metadata.compressed) files.set_compression("zstd");
  return {};
}

Result<BagMessage> Rosbag2Reader::Impl::unpack(BagMessage message) {
  const bool cdr = message.connection->format.serialization == Serialization::kCdr;
  if (!cdr || !is_zstd_frame(message.data)) return message;
  if (auto ok = unpack_frame(message.data, memory_limit, unpacked); !ok) {
    return failure(fmt::format("{}: topic '{}', at {} ns: {}", files.name(),
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
  auto impl =
      std::unique_ptr<Impl>(new Impl{options.memory_limit, MergedSource(recording.string())});
  if (auto ok = impl->open(*metadata, options); !ok) return tl::unexpected(ok.error());
  return Rosbag2Reader(std::move(impl));
}

std::string Rosbag2Reader::name() const { return impl_->files.name(); }

const std::vector<BagConnection>& Rosbag2Reader::connections() const {
  return impl_->files.connections();
}

const BagSummary& Rosbag2Reader::summary() const { return impl_->files.summary(); }

void Rosbag2Reader::select(std::span<const std::string> topics) { impl_->files.select(topics); }

Result<std::optional<BagMessage>> Rosbag2Reader::next() {
  auto message = impl_->files.next();
  if (!message || !*message) return message;
  auto unpacked = impl_->unpack(**message);
  if (!unpacked) return tl::unexpected(unpacked.error());
  return std::optional<BagMessage>(*unpacked);
}

void Rosbag2Reader::rewind() { impl_->files.rewind(); }

}  // namespace aims
