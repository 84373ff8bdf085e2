// SPDX-License-Identifier: BSD-3-Clause
#include "core/files/output_folder.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

void write(const fs::path& file, const char* text) { std::ofstream(file) << text; }

TEST(OutputFolder, AppearsOnlyOnCommit) {
  const TemporaryFolder temporary;
  const fs::path out = temporary.path() / "deep" / "run";
  auto folder = OutputFolder::create(out, false);
  ASSERT_TRUE(folder) << folder.error().message;
  write(folder->path() / "scores.json", "{}");
  EXPECT_FALSE(fs::exists(out));
  ASSERT_TRUE(folder->commit());
  EXPECT_TRUE(fs::exists(out / "scores.json"));
  EXPECT_FALSE(fs::exists(temporary.path() / "deep" / "run.partial"));
}

TEST(OutputFolder, LeavesNothingWithoutCommit) {
  const TemporaryFolder temporary;
  { auto folder = OutputFolder::create(temporary.path() / "new" / "deep" / "run", false); }
  EXPECT_TRUE(fs::is_empty(temporary.path()));
}

TEST(OutputFolder, NeverReplacesResultsWithoutOverwrite) {
  const TemporaryFolder temporary;
  const fs::path out = temporary.path() / "run";
  fs::create_directory(out);
  write(out / "scores.json", "old");
  const auto refused = OutputFolder::create(out, false);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("--overwrite"), std::string::npos);
  {
    auto folder = OutputFolder::create(out, true);
    ASSERT_TRUE(folder);
    EXPECT_TRUE(fs::exists(out / "scores.json")) << "the old run stays until the new one is whole";
    ASSERT_TRUE(folder->commit());
  }
  EXPECT_FALSE(fs::exists(out / "scores.json"));
}

TEST(OutputFolder, NeverReplacesAFolderThatHoldsNoResults) {
  const TemporaryFolder temporary;
  write(temporary.path() / "thesis.tex", "years of work");
  EXPECT_FALSE(OutputFolder::create(temporary.path(), true));
  EXPECT_TRUE(fs::exists(temporary.path() / "thesis.tex"));
}

TEST(OutputFolder, RefusesWhileAnotherRunWritesThere) {
  const TemporaryFolder temporary;
  auto first = OutputFolder::create(temporary.path() / "run", false);
  ASSERT_TRUE(first);
  EXPECT_FALSE(OutputFolder::create(temporary.path() / "run", false));
}

TEST(OutputFolder, NamesTheFolderThatCannotBeWritten) {
  const auto folder = OutputFolder::create("/proc/nowhere/run", false);
  ASSERT_FALSE(folder);
  EXPECT_NE(folder.error().message.find("/proc/nowhere"), std::string::npos);
}

TEST(OutputFolder, ReplacesTheRemainsOfAKilledRun) {
  const TemporaryFolder temporary;
  fs::create_directory(temporary.path() / "run.partial");
  write(temporary.path() / "run.partial" / "half", "");
  auto folder = OutputFolder::create(temporary.path() / "run", false);
  ASSERT_TRUE(folder) << folder.error().message;
  EXPECT_FALSE(fs::exists(folder->path() / "half"));
}

}  // namespace
}  // namespace aims
