// SPDX-License-Identifier: BSD-3-Clause
// Replays what fuzzing has found worth keeping, in the ordinary build.
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>

#include "core/files/atomic_file.hpp"
#include "core/files/byte_cursor.hpp"
#include "tests/fuzz/fuzz_targets.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

void replay(const std::string& target, void (*run)(std::span<const std::uint8_t>)) {
  int count = 0;
  for (const auto& entry : fs::directory_iterator(fs::path(AIMS_CORPUS) / target)) {
    SCOPED_TRACE(entry.path());
    const std::string bytes = read_file(entry.path()).value();
    run({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
    ++count;
  }
  EXPECT_GT(count, 3) << target;
}

TEST(FuzzCorpus, Bags) { replay("bag", fuzz_bag); }
TEST(FuzzCorpus, McapFiles) { replay("mcap", fuzz_mcap); }
TEST(FuzzCorpus, Captures) { replay("pcap", fuzz_pcap); }
TEST(FuzzCorpus, OusterPackets) { replay("ouster", fuzz_ouster); }
TEST(FuzzCorpus, SqliteFiles) { replay("db3", fuzz_db3); }
TEST(FuzzCorpus, Messages) { replay("message", fuzz_message); }
TEST(FuzzCorpus, MessagesOfRos2) { replay("cdr", fuzz_cdr); }
TEST(FuzzCorpus, Recordings) { replay("recording", fuzz_recording); }
TEST(FuzzCorpus, StatesOfRobots) { replay("states", fuzz_states); }
TEST(FuzzCorpus, SingleLegs) { replay("legs", fuzz_legs); }
TEST(FuzzCorpus, PacketsInBags) { replay("packets", fuzz_packets); }
TEST(FuzzCorpus, MergedBags) { replay("merged", fuzz_merged); }
TEST(FuzzCorpus, Yaml) { replay("yaml", fuzz_yaml); }
TEST(FuzzCorpus, Tables) { replay("tables", fuzz_tables); }
TEST(FuzzCorpus, Json) { replay("json", fuzz_json); }

}  // namespace
}  // namespace aims
