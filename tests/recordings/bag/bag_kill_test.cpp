// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <memory>
#include <random>

#include "tests/recordings/bag/bag_samples.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kChunkSize = 30'000;

SampleMessage message_at(std::uint32_t i) {
  std::mt19937 random(i);
  return {"/a", kSecond + i, std::string(100 + random() % 2000, static_cast<char>('a' + i % 26))};
}

/// In the child: writes until killed; `written` counts the messages whose write came back.
[[noreturn]] void write_forever(const fs::path& file, BagCompression compression,
                                std::atomic<std::uint32_t>& written) {
  auto bag = BagWriter::create(file, {compression, kChunkSize});
  if (!bag) _exit(1);
  bag->add_connection("/a", string_type());
  for (std::uint32_t i = 0;; ++i) {
    const SampleMessage message = message_at(i);
    if (!bag->write(0, message.time, bytes_of(message.bytes))) _exit(2);
    written.store(i + 1);
  }
}

/// Messages among the first `written` that lie in chunks which were closed for their size.
std::size_t in_closed_chunks(std::uint32_t written) {
  constexpr std::size_t kMessageOverhead = 4 + (4 + 9) + (4 + 4) + (4 + 13) + 4;
  const std::size_t connection_record = 37 + 106 + string_type().definition.size();
  std::size_t closed = 0;
  std::size_t size = connection_record;  // at the start of the first chunk
  for (std::uint32_t i = 0; i < written; ++i) {
    size += kMessageOverhead + message_at(i).bytes.size();
    if (size < kChunkSize) continue;
    closed = i + 1;
    size = 0;
  }
  return closed;
}

/// Lines that librosbag-storage lists of the bag; -1 when it cannot.
int listed_by_rosbag_storage(const fs::path& file) {
#ifdef AIMS_ROSBAG_STORAGE_TOOL
  const std::string command = AIMS_ROSBAG_STORAGE_TOOL " list '" + file.string() + "'";
  FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return -1;
  int lines = 0;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) lines += c == '\n';
  return pclose(pipe) == 0 ? lines : -1;
#else
  return static_cast<int>(read_all(file).messages.size());
#endif
}

void check_one_kill(std::uint32_t seed) {
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  const TemporaryFolder folder;
  const auto file = folder.path() / "killed.bag";
  void* page = mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  auto* written = new (page) std::atomic<std::uint32_t>(0);
  const auto compression = seed % 3 == 0 ? BagCompression::kLz4 : BagCompression::kNone;
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) write_forever(file, compression, *written);
  // Killed at a count, and a little later: anywhere between and within the writes.
  const std::uint32_t wanted = 1 + random() % 600;
  while (written->load() < wanted) {
  }
  const std::uint32_t spins = random() % 30'000;
  for (std::uint32_t i = 0; i < spins; ++i) static_cast<void>(written->load());
  kill(child, SIGKILL);
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_TRUE(WIFSIGNALED(status));
  const std::uint32_t count = written->load();
  munmap(page, 4096);
  const ReadOutcome read = read_all(file);
  ASSERT_EQ(read.error, "");
  EXPECT_GE(read.messages.size(), in_closed_chunks(count));
  for (std::uint32_t i = 0; i < read.messages.size(); ++i) {
    ASSERT_EQ(read.messages[i], message_at(i));
  }
  EXPECT_EQ(listed_by_rosbag_storage(file), static_cast<int>(read.messages.size()));
}

TEST(BagWriter, LeavesAValidBagWhenKilled) {
  for (std::uint32_t seed = 0; seed < 40; ++seed) check_one_kill(seed);
}

}  // namespace
}  // namespace aims
