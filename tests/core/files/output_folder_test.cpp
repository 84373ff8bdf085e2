// SPDX-License-Identifier: BSD-3-Clause
#include "core/files/output_folder.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "core/files/atomic_file.hpp"
#include "core/files/manifest.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

void write(const fs::path& file, const char* text) { std::ofstream(file) << text; }

/// Results of one file, as a command writes them.
void write_results(const fs::path& out, const char* name, bool overwrite = false) {
  auto folder = OutputFolder::create(out, overwrite);
  ASSERT_TRUE(folder) << folder.error().message;
  write(folder->path() / name, "result");
  const auto committed = folder->commit();
  ASSERT_TRUE(committed) << committed.error().message;
}

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
  write_results(out, "scores.json");
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

TEST(OutputFolder, ReplacesResultsWhateverTheirNames) {
  const TemporaryFolder temporary;
  const fs::path out = temporary.path() / "run";
  write_results(out, "estimate.json");
  write_results(out, "other.json", true);
  EXPECT_FALSE(fs::exists(out / "estimate.json"));
  EXPECT_TRUE(fs::exists(out / "other.json"));
}

TEST(OutputFolder, NeverReplacesAFolderWithoutAManifestAndNamesItsFiles) {
  const TemporaryFolder temporary;
  write(temporary.path() / "thesis.tex", "years of work");
  write(temporary.path() / "scores.json", "{}");
  const auto refused = OutputFolder::create(temporary.path(), true);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find(".aims-files"), std::string::npos);
  EXPECT_NE(refused.error().message.find("scores.json, thesis.tex"), std::string::npos)
      << refused.error().message;
  EXPECT_TRUE(fs::exists(temporary.path() / "thesis.tex"));
}

TEST(OutputFolder, OverwritingKeepsWhatOthersPutThere) {
  const TemporaryFolder temporary;
  const fs::path out = temporary.path() / "run";
  write_results(out, "scores.json");
  fs::create_directory(out / "notes");
  write(out / "notes" / "mine.txt", "mine");
  write(out / "new.csv", "mine too");
  write_results(out, "new.csv", true);
  EXPECT_FALSE(fs::exists(out / "scores.json"));
  EXPECT_EQ(*read_file(out / "notes" / "mine.txt"), "mine");
  EXPECT_EQ(*read_file(out / "new.csv"), "result");
  EXPECT_EQ(*read_file(out / "new.csv.kept"), "mine too");
  EXPECT_FALSE(fs::exists(temporary.path() / "run.replaced"));
  write_results(out, "new.csv", true);
  EXPECT_EQ(*read_file(out / "new.csv.kept"), "mine too") << "it stays the user's";
}

TEST(OutputFolder, AManifestRemovesNothingOutsideItsFolder) {
  const TemporaryFolder temporary;
  const fs::path out = temporary.path() / "run";
  write(temporary.path() / "thesis.tex", "years of work");
  write_results(out, "scores.json");
  write(out / ".aims-files", "scores.json\n../thesis.tex\n");
  write_results(out, "scores.json", true);
  EXPECT_TRUE(fs::exists(temporary.path() / "thesis.tex"));
}

TEST(OutputFolder, AnEmptyFolderIsAsGoodAsNone) {
  const TemporaryFolder temporary;
  const fs::path out = temporary.path() / "run";
  fs::create_directory(out);
  write_results(out, "scores.json");
  EXPECT_TRUE(fs::exists(out / "scores.json"));
}

TEST(OutputFolder, NeverReplacesTheJobsOfASuite) {
  const TemporaryFolder temporary;
  const fs::path out = temporary.path() / "run";
  write_results(out, "jobs.csv");
  EXPECT_FALSE(OutputFolder::create(out, true));
}

TEST(OutputFolder, AFileWrittenLaterIsReplacedOnceItIsListed) {
  const TemporaryFolder temporary;
  const fs::path out = temporary.path() / "run";
  write_results(out, "scores.json");
  write(out / "page.html", "page");
  add_to_manifest(out / "page.html");
  write_results(out, "scores.json", true);
  EXPECT_FALSE(fs::exists(out / "page.html"));
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
