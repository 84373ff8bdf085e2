// SPDX-License-Identifier: BSD-3-Clause
#include "core/files/atomic_file.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <filesystem>

#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

std::size_t files_in(const fs::path& directory) {
  return static_cast<std::size_t>(
      std::distance(fs::directory_iterator(directory), fs::directory_iterator()));
}

TEST(AtomicFile, WritesReplacesAndLeavesNothingElse) {
  const TemporaryFolder directory;
  const fs::path file = directory.path() / "f.txt";
  ASSERT_TRUE(write_file_atomically(file, "first"));
  ASSERT_TRUE(write_file_atomically(file, std::string_view("sec\0nd", 6)));
  EXPECT_EQ(read_file(file).value(), std::string("sec\0nd", 6));
  EXPECT_EQ(files_in(directory.path()), 1U);
}

TEST(AtomicFile, WritesBytesAndEmptyFiles) {
  const TemporaryFolder directory;
  const fs::path file = directory.path() / "f.bin";
  const std::array<std::byte, 3> bytes = {std::byte{0}, std::byte{255}, std::byte{10}};
  ASSERT_TRUE(write_file_atomically(file, std::span<const std::byte>(bytes)));
  EXPECT_EQ(read_file(file).value(), std::string("\0\xff\n", 3));
  ASSERT_TRUE(write_file_atomically(file, ""));
  EXPECT_EQ(read_file(file).value(), "");
}

TEST(AtomicFile, WrittenInPartsAppearsOnCommit) {
  const TemporaryFolder directory;
  const fs::path file = directory.path() / "f.txt";
  {
    auto dropped = AtomicFile::create(file);
    ASSERT_TRUE(dropped);
    ASSERT_TRUE(dropped->write(std::string_view("half")));
    EXPECT_FALSE(fs::exists(file));
  }
  EXPECT_EQ(files_in(directory.path()), 0U);
  auto kept = AtomicFile::create(file);
  ASSERT_TRUE(kept);
  ASSERT_TRUE(kept->write(std::string_view("one ")));
  ASSERT_TRUE(kept->write(std::string_view("two")));
  ASSERT_TRUE(kept->commit());
  EXPECT_EQ(read_file(file).value(), "one two");
  EXPECT_EQ(files_in(directory.path()), 1U);
}

TEST(AtomicFile, ErrorsNameTheFileAndTheReason) {
  const TemporaryFolder directory;
  const fs::path orphan = directory.path() / "gone" / "f.txt";
  EXPECT_EQ(write_file_atomically(orphan, "x").error().message,
            orphan.string() + ": cannot be written: no directory '" +
                orphan.parent_path().string() + "'");
  EXPECT_EQ(write_file_atomically(directory.path(), "x").error().message,
            directory.path().string() + ": cannot be written: it is a directory");
  EXPECT_EQ(read_file(orphan).error().message,
            orphan.string() + ": cannot be read: No such file or directory");
  EXPECT_EQ(read_file(directory.path()).error().message,
            directory.path().string() + ": cannot be read: Is a directory");
}

TEST(AtomicFile, AFullDiskIsAnErrorAndKeepsTheOldContent) {
  // The temporary's name leads to a device that accepts an open and refuses a write.
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  const TemporaryFolder directory;
  const fs::path file = directory.path() / "f.txt";
  ASSERT_TRUE(write_file_atomically(file, "old"));
  std::array<char, 256> host{};
  ASSERT_EQ(::gethostname(host.data(), host.size() - 1), 0);
  const fs::path temporary =
      file.string() + "." + host.data() + "." + std::to_string(::getpid()) + ".tmp";
  fs::create_symlink("/dev/full", temporary);
  const auto written = write_file_atomically(file, "new");
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().message,
            file.string() + ": cannot be written: No space left on device");
  EXPECT_EQ(read_file(file).value(), "old");
  EXPECT_EQ(files_in(directory.path()), 1U);
}

}  // namespace
}  // namespace aims
