// SPDX-License-Identifier: BSD-3-Clause
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <string>

#include "recordings/bag/bag_reader.hpp"
#include "recordings/mcap/mcap_reader.hpp"
#include "recordings/pcap/pcap_reader.hpp"
#include "recordings/rosbag2/rosbag2_reader.hpp"
#include "tests/fuzz/demand.hpp"
#include "tests/fuzz/fuzz_targets.hpp"
#include "tests/fuzz/memory_file.hpp"
#include "tests/fuzz/touch.hpp"

namespace aims {
namespace {

/// Reads every message of a file, which come in order of time.
template <class Reader>
void read_messages(const std::filesystem::path& file, bool recover) {
  auto bag = Reader::open(file, {recover, std::size_t{16} << 20});
  if (!bag) return demand_readable(bag.error());
  std::map<const BagConnection*, Result<MessageDecoder>> decoders;
  Time last = 0;
  while (true) {
    const auto message = bag->next();
    if (!message || !*message) break;
    const BagMessage& each = **message;
    if (each.record_time < last) std::abort();
    last = each.record_time;
    auto known = decoders.find(each.connection);
    if (known == decoders.end()) {
      known = decoders
                  .emplace(each.connection, MessageDecoder::create(each.connection->type,
                                                                   each.connection->definition,
                                                                   each.connection->format))
                  .first;
    }
    if (known->second) touch_message(*known->second, each.data);
  }
}

template <class Reader>
void read_file_as(const std::filesystem::path& file) {
  for (const bool recover : {false, true}) {
    read_messages<Reader>(file, recover);
    touch_recording(file, recover);
  }
}

/// A file with a name of its own, which SQLite needs, for as long as the object lives.
class NamedFile {
 public:
  explicit NamedFile(std::span<const std::uint8_t> bytes) {
    std::ofstream stream(path_, std::ios::binary);
    const std::string_view text = text_of(bytes);
    stream.write(text.data(), static_cast<std::streamsize>(text.size()));
  }
  NamedFile(const NamedFile&) = delete;
  NamedFile& operator=(const NamedFile&) = delete;
  ~NamedFile() { std::filesystem::remove(path_); }

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_ =
      std::filesystem::temp_directory_path() / ("aims-fuzz-" + std::to_string(::getpid()) + ".db3");
};

}  // namespace

void fuzz_bag(std::span<const std::uint8_t> input) {
  read_file_as<BagReader>(MemoryFile(std::as_bytes(input)).path());
}

void fuzz_mcap(std::span<const std::uint8_t> input) {
  read_file_as<McapReader>(MemoryFile(std::as_bytes(input)).path());
}

void fuzz_pcap(std::span<const std::uint8_t> input) {
  read_file_as<PcapReader>(MemoryFile(std::as_bytes(input)).path());
}

void fuzz_db3(std::span<const std::uint8_t> input) {
  read_file_as<Rosbag2Reader>(NamedFile(input).path());
}

}  // namespace aims
