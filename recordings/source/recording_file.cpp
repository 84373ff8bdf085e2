// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/source/recording_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "recordings/bag/bag_reader.hpp"
#include "recordings/bag/merged_source.hpp"
#include "recordings/bag/wrapped_source.hpp"
#include "recordings/csv/csv_reader.hpp"
#include "recordings/mcap/mcap_reader.hpp"
#include "recordings/mcap/mcap_writer.hpp"
#include "recordings/pcap/pcap_reader.hpp"
#include "recordings/rosbag2/rosbag2_metadata.hpp"
#include "recordings/rosbag2/rosbag2_reader.hpp"
#include "recordings/rosbag2/rosbag2_writer.hpp"
#include "recordings/source/compressed_clouds.hpp"
#include "recordings/source/decided_start.hpp"
#include "recordings/source/joined_legs.hpp"
#include "recordings/source/message_stamps.hpp"
#include "recordings/source/packet_source.hpp"
#include "recordings/source/recorder_clocks.hpp"
#include "recordings/source/split_imu.hpp"
#include "recordings/source/spread_batches.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kFewMessages = 10;  ///< may have one record time by chance

class StampedSource final : public WrappedSource {
 public:
  StampedSource(std::unique_ptr<MessageSource> source, MessageStamps stamps, Time start, Time end)
      : WrappedSource(std::move(source)), stamps_(std::move(stamps)), clock_(start) {
    summary_ = source_.summary();
    summary_->start = start;
    summary_->end = end;
    summary_->recorded_at_stamps = true;
  }

  Result<std::optional<BagMessage>> next() override {
    auto message = read();
    if (!message || !*message) return message;
    clock_ = std::max(clock_, stamps_.of(**message).value_or(0));
    (*message)->record_time = clock_;
    return message;
  }

  void rewind() override {
    WrappedSource::rewind();
    clock_ = summary().start;
  }

 private:
  MessageStamps stamps_;
  Time clock_;  ///< latest stamp so far
};

/// Where a recording has one record time for all of its messages, as some converters write it,
/// replaces `source` by one whose messages are recorded at the latest stamp of those before them in
/// the file; its summary says so. Without stamps nothing changes. Reads the recording once;
/// rewinds.
Result<void> restore_record_times(std::unique_ptr<MessageSource>& source) {
  const BagSummary& summary = source->summary();
  if (summary.start != summary.end || summary.messages < kFewMessages) return {};
  MessageStamps stamps(source->connections());
  std::optional<Time> start;
  Time end = 0;
  while (true) {
    const auto message = source->next();
    if (!message) return tl::unexpected(message.error());
    if (!*message) break;
    const auto stamp = stamps.of(**message);
    if (!stamp) continue;
    start = std::min(start.value_or(*stamp), *stamp);
    end = std::max(end, *stamp);
  }
  source->rewind();
  if (!start || *start == end) return {};
  source = std::make_unique<StampedSource>(std::move(source), std::move(stamps), *start, end);
  return {};
}

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

bool is_same(const fs::path& a, const fs::path& b) {
  std::error_code ignored;
  return fs::equivalent(a, b, ignored);
}

std::string first_bytes(const fs::path& file) {
  std::string start(512, '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(start.data(), static_cast<std::streamsize>(start.size()));
  start.resize(static_cast<std::size_t>(std::max<std::streamsize>(stream.gcount(), 0)));
  return start;
}

template <class Reader>
Result<std::unique_ptr<MessageSource>> opened(const fs::path& file, BagOpenOptions options) {
  auto reader = Reader::open(file, options);
  if (!reader) return tl::unexpected(reader.error());
  return std::make_unique<Reader>(std::move(*reader));
}

/// The recordings in a folder, by name; none if it is one recording of rosbag2, whole or not.
std::vector<fs::path> recordings_in(const fs::path& folder) {
  std::error_code ignored;
  if (fs::exists(folder / kRosbag2Metadata, ignored)) return {};
  const auto files_of_one = rosbag2_files(folder);
  std::vector<fs::path> found;
  bool others = false;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    if (!format_by_content(entry.path())) continue;
    found.push_back(entry.path());
    others = others || std::ranges::find(files_of_one, entry.path()) == files_of_one.end();
  }
  if (!others) return {};
  std::ranges::sort(found);
  return found;
}

Result<std::unique_ptr<MessageSource>> merged(const std::string& name,
                                              const std::vector<fs::path>& files,
                                              const BagOpenOptions& options) {
  std::vector<std::unique_ptr<MessageSource>> sources;
  for (std::size_t i = 0; i < files.size(); ++i) {
    const bool again = std::any_of(files.begin(), files.begin() + static_cast<std::ptrdiff_t>(i),
                                   [&](const fs::path& each) { return is_same(each, files[i]); });
    if (again) {
      return failure(fmt::format("{}: named twice, expected each file of a recording once",
                                 files[i].string()));
    }
    auto source = open_recording(files[i], options);
    if (!source) return tl::unexpected(source.error());
    sources.push_back(std::move(*source));
  }
  std::vector<Duration> shifts(sources.size(), 0);
  if (options.one_clock) shifts = recorder_clock_shifts(sources);
  auto all = std::make_unique<MergedSource>(name);
  for (std::size_t i = 0; i < sources.size(); ++i) all->add(std::move(sources[i]), shifts[i]);
  return all;
}

/// Error for a file that is empty or packed as a whole.
Result<void> refuse_packed(const fs::path& file) {
  constexpr auto kPacked =
      std::to_array<std::pair<std::string_view, std::string_view>>({{"\x1f\x8b", "gunzip"},
                                                                    {"BZh", "bunzip2"},
                                                                    {"\xfd\x37zXZ", "unxz"},
                                                                    {"\x28\xb5\x2f\xfd", "unzstd"},
                                                                    {"\x04\x22\x4d\x18", "unlz4"},
                                                                    {"7z\xbc\xaf", "7z x"},
                                                                    {"Rar!", "unrar"},
                                                                    {"PK", "unzip"}});
  std::error_code ignored;
  if (!fs::is_regular_file(file, ignored)) return {};
  const std::string start = first_bytes(file);
  if (start.empty()) return failure(fmt::format("{}: the file is empty", file.string()));
  for (const auto& [sign, program] : kPacked) {
    if (!start.starts_with(sign)) continue;
    return failure(
        fmt::format("{}: the file is packed: unpack it with {}", file.string(), program));
  }
  if (const std::string_view foreign = foreign_content(start); !foreign.empty()) {
    return failure(fmt::format("{}: {}", file.string(), foreign));
  }
  return {};
}

template <class Writer>
Result<std::unique_ptr<MessageSink>> created(const fs::path& file, BagWriterOptions options) {
  auto writer = Writer::create(file, options);
  if (!writer) return tl::unexpected(writer.error());
  return std::make_unique<Writer>(std::move(*writer));
}

}  // namespace

std::string untimed_text(const BagSummary& summary) {
  return fmt::format("{} rows of the table have no time: they are left out", summary.untimed_rows);
}

std::string_view foreign_content(std::string_view start) {
  constexpr std::size_t kTarSign = 257;
  if (start.size() > kTarSign && start.substr(kTarSign).starts_with("ustar")) {
    return "the file is an archive: unpack it with tar";
  }
  const std::size_t first = start.find_first_not_of(" \t\r\n");
  const std::string_view text = start.substr(std::min(first, start.size()));
  if (text.starts_with("version https://git-lfs")) {
    return "the file is a pointer of Git LFS: fetch its content with git lfs pull";
  }
  constexpr auto kEncrypted = std::to_array<std::string_view>(
      {"Salted__", "age-encryption.org", "-----BEGIN PGP MESSAGE", "-----BEGIN AGE ENCRYPTED"});
  if (std::ranges::any_of(kEncrypted, [&](auto sign) { return text.starts_with(sign); })) {
    return "the file is encrypted: decrypt it first";
  }
  const bool page = text.starts_with("<!DOCTYPE") || text.starts_with("<!doctype") ||
                    text.starts_with("<html") || text.starts_with("<HTML");
  return page ? "the file is a web page, as of a download that failed: download it again" : "";
}

std::optional<RecordingFormat> format_by_content(const fs::path& file) {
  std::error_code ignored;
  if (fs::exists(file / kRosbag2Metadata, ignored)) return RecordingFormat::kRosbag2;
  if (!fs::is_regular_file(file, ignored)) return std::nullopt;  // a pipe would hang
  const std::string start = first_bytes(file);
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
  const std::vector<fs::path> with = std::exchange(options.with, {});
  if (!with.empty()) {
    std::vector<fs::path> files = {file};
    files.insert(files.end(), with.begin(), with.end());
    return merged(fmt::format("{} (+{})", file.string(), with.size()), files, options);
  }
  // What has no known beginning is refused by the reader for its name, or by that of bags.
  std::error_code ignored;
  if (fs::is_directory(file, ignored)) {
    const auto parts = recordings_in(file);
    if (!parts.empty()) return merged(file.string(), parts, options);
    return opened<Rosbag2Reader>(file, options);
  }
  if (auto plain = refuse_packed(file); !plain) return tl::unexpected(plain.error());
  const auto known = format_by_content(file);
  const auto format = known ? known : format_by_name(file);
  if (format == RecordingFormat::kMcap) return opened<McapReader>(file, options);
  if (format == RecordingFormat::kRosbag2) return opened<Rosbag2Reader>(file, options);
  if (format == RecordingFormat::kPcap) return opened<PcapReader>(file, options);
  if (format == RecordingFormat::kCsv) return opened<CsvReader>(file, options);
  return opened<BagReader>(file, options);
}

Result<std::unique_ptr<MessageSource>> open_sensor_recording(const fs::path& file,
                                                             BagOpenOptions options,
                                                             bool without_lidar) {
  options.one_clock = true;
  const bool as_live = options.as_live;
  auto source = open_recording(file, std::move(options));
  if (!source) return source;
  if (as_live) {
    if (auto ok = leave_out_forgotten(*source); !ok) return tl::unexpected(ok.error());
  }
  if (auto restored = restore_record_times(*source); !restored) {
    return tl::unexpected(restored.error());
  }
  const auto decoded = decode_packets(*source);
  if (!decoded && !without_lidar) return tl::unexpected(decoded.error());
  const auto unpacked = unpack_clouds(*source);
  if (!unpacked && !without_lidar) return tl::unexpected(unpacked.error());
  spread_batches(*source);
  join_split_imu(*source);
  join_single_legs(*source);
  return source;
}

Result<std::unique_ptr<MessageSink>> create_recording(const fs::path& file, RecordingFormat format,
                                                      BagWriterOptions options) {
  if (format == RecordingFormat::kMcap) return created<McapWriter>(file, options);
  if (format == RecordingFormat::kRosbag2) return created<Rosbag2Writer>(file, options);
  return created<BagWriter>(file, options);
}

}  // namespace aims
