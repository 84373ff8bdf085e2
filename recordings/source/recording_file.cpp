// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/source/recording_file.hpp"

#include <array>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "recordings/bag/bag_reader.hpp"
#include "recordings/csv/csv_reader.hpp"
#include "recordings/mcap/mcap_reader.hpp"
#include "recordings/mcap/mcap_writer.hpp"
#include "recordings/pcap/pcap_reader.hpp"
#include "recordings/rosbag2/rosbag2_metadata.hpp"
#include "recordings/rosbag2/rosbag2_reader.hpp"
#include "recordings/rosbag2/rosbag2_writer.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

struct FormatSign {
  RecordingFormat format;
  std::string_view extension;
  std::string_view first_bytes;  ///< empty: known by its name alone
};

constexpr auto kSigns = std::to_array<FormatSign>({
    {RecordingFormat::kBag, ".bag", "#ROS"},
    {RecordingFormat::kMcap, ".mcap", "\x89MCAP"},
    {RecordingFormat::kRosbag2, ".db3", "SQLite format 3"},
    {RecordingFormat::kPcap, ".pcap", "\xd4\xc3\xb2\xa1"},
    {RecordingFormat::kPcap, ".pcap", "\xa1\xb2\xc3\xd4"},
    {RecordingFormat::kPcap, ".pcap", "\x4d\x3c\xb2\xa1"},
    {RecordingFormat::kPcap, ".pcap", "\xa1\xb2\x3c\x4d"},
    {RecordingFormat::kPcap, ".pcapng", "\x0a\x0d\x0d\x0a"},
    {RecordingFormat::kCsv, ".yaml", ""},
});

template <class Reader>
Result<std::unique_ptr<MessageSource>> opened(const fs::path& file, BagOpenOptions options) {
  auto reader = Reader::open(file, options);
  if (!reader) return tl::unexpected(reader.error());
  return std::make_unique<Reader>(std::move(*reader));
}

template <class Writer>
Result<std::unique_ptr<MessageSink>> created(const fs::path& file, BagWriterOptions options) {
  auto writer = Writer::create(file, options);
  if (!writer) return tl::unexpected(writer.error());
  return std::make_unique<Writer>(std::move(*writer));
}

}  // namespace

std::optional<RecordingFormat> format_by_content(const fs::path& file) {
  std::error_code ignored;
  if (fs::exists(file / kRosbag2Metadata, ignored)) return RecordingFormat::kRosbag2;
  if (!fs::is_regular_file(file, ignored)) return std::nullopt;  // a pipe would hang
  std::string start(16, '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(start.data(), static_cast<std::streamsize>(start.size()));
  for (const FormatSign& sign : kSigns) {
    if (!sign.first_bytes.empty() && start.starts_with(sign.first_bytes)) return sign.format;
  }
  return std::nullopt;
}

std::optional<RecordingFormat> format_by_name(const fs::path& file) {
  for (const FormatSign& sign : kSigns) {
    if (file.extension() == sign.extension) return sign.format;
  }
  return std::nullopt;
}

Result<std::unique_ptr<MessageSource>> open_recording(const fs::path& file,
                                                      BagOpenOptions options) {
  // What has no known beginning is refused by the reader for its name, or by that of bags.
  std::error_code ignored;
  if (fs::is_directory(file, ignored)) return opened<Rosbag2Reader>(file, options);
  const auto known = format_by_content(file);
  const auto format = known ? known : format_by_name(file);
  if (format == RecordingFormat::kMcap) return opened<McapReader>(file, options);
  if (format == RecordingFormat::kRosbag2) return opened<Rosbag2Reader>(file, options);
  if (format == RecordingFormat::kPcap) return opened<PcapReader>(file, options);
  if (format == RecordingFormat::kCsv) return opened<CsvReader>(file, options);
  return opened<BagReader>(file, options);
}

Result<std::unique_ptr<MessageSink>> create_recording(const fs::path& file, RecordingFormat format,
                                                      BagWriterOptions options) {
  if (format == RecordingFormat::kMcap) return created<McapWriter>(file, options);
  if (format == RecordingFormat::kRosbag2) return created<Rosbag2Writer>(file, options);
  return created<BagWriter>(file, options);
}

}  // namespace aims
