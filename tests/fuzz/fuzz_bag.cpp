// SPDX-License-Identifier: BSD-3-Clause
#include <cstdlib>
#include <map>

#include "recordings/bag/bag_reader.hpp"
#include "tests/fuzz/fuzz_targets.hpp"
#include "tests/fuzz/memory_file.hpp"
#include "tests/fuzz/touch.hpp"

namespace aims {
namespace {

void read_bag(const std::filesystem::path& file, bool recover) {
  auto bag = BagReader::open(file, {recover, std::size_t{16} << 20});
  if (!bag) return;
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
                                                                   each.connection->definition))
                  .first;
    }
    if (known->second) touch_message(*known->second, each.data);
  }
}

}  // namespace

void fuzz_bag(std::span<const std::uint8_t> input) {
  const MemoryFile file(std::as_bytes(input));
  for (const bool recover : {false, true}) {
    read_bag(file.path(), recover);
    touch_recording(file.path(), recover);
  }
}

}  // namespace aims
