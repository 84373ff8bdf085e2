// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/rosbag2/temporary_file.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <iterator>

#include "core/files/atomic_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

class TemporaryFiles : public testing::Test {
 protected:
  TemporaryFiles() { ::setenv("TMPDIR", folder_.path().c_str(), 1); }
  ~TemporaryFiles() override { ::unsetenv("TMPDIR"); }

  fs::path path(const std::string& name) const { return folder_.path() / name; }

  /// What is in the folder for temporary files.
  int files() const {
    return static_cast<int>(std::distance(fs::directory_iterator(folder_.path()), {}));
  }

  /// A folder as a process leaves it that is killed, made so long ago.
  fs::path left(const std::string& name, std::chrono::minutes age) const {
    fs::create_directory(path(name));
    EXPECT_TRUE(write_file_atomically(path(name + "/walk.db3"), std::string_view("bytes")));
    fs::last_write_time(path(name), fs::file_time_type::clock::now() - age);
    return path(name);
  }

  TemporaryFolder folder_;
};

TEST_F(TemporaryFiles, HaveNoNameWhileTheyAreWrittenAndNoneAfter) {
  const std::string text = "unpacked";
  {
    auto file = TemporaryFile::create("walk.db3", 8);
    ASSERT_TRUE(file) << file.error().message;
    ASSERT_TRUE(file->write_at(0, std::as_bytes(std::span(text))));
    EXPECT_EQ(files(), 0) << "this process may be killed here";
    ASSERT_TRUE(file->publish());
    EXPECT_EQ(file->path().filename(), "walk.db3");
    EXPECT_EQ(read_file(file->path()).value(), text);
  }
  EXPECT_EQ(files(), 0);
  const auto huge = TemporaryFile::create("walk.db3", std::uint64_t{1} << 60);
  ASSERT_FALSE(huge);
  EXPECT_NE(huge.error().message.find("unpacked it needs 1152921504606846976 bytes in "),
            std::string::npos);
}

TEST_F(TemporaryFiles, OfProcessesThatWereKilledAreRemovedAndNoOthers) {
  using std::chrono::minutes;
  left("aims-unpacked-killed", minutes(2));
  const fs::path held = left("aims-unpacked-inuse1", minutes(2));
  const int holder = ::open(held.c_str(), O_RDONLY);
  ASSERT_EQ(::flock(holder, LOCK_EX), 0);
  left("aims-unpacked-young1", minutes(0));
  left("aims-golden", minutes(100));
  ASSERT_TRUE(TemporaryFile::create("walk.db3", 1));
  ::close(holder);
  EXPECT_FALSE(fs::exists(path("aims-unpacked-killed")));
  for (const char* kept : {"aims-unpacked-inuse1", "aims-unpacked-young1", "aims-golden"}) {
    EXPECT_TRUE(fs::exists(path(std::string(kept) + "/walk.db3"))) << kept;
  }
}

}  // namespace
}  // namespace aims
