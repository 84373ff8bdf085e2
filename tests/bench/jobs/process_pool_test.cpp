// SPDX-License-Identifier: BSD-3-Clause
#include "bench/jobs/process_pool.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <map>
#include <stdexcept>

namespace aims {
namespace {

/// Waits for all; by key.
std::map<std::size_t, EndedProcess> all_of(ProcessPool& pool) {
  std::map<std::size_t, EndedProcess> ended;
  while (!pool.is_idle()) {
    for (EndedProcess& each : pool.wait(10.0)) ended[each.key] = std::move(each);
  }
  return ended;
}

TEST(ProcessPool, GivesBackWhatEachReturns) {
  ProcessPool pool(3);
  const std::string remembered = "of the caller";
  const std::string large(1'000'000, 'x');  // more than a pipe holds
  ASSERT_TRUE(pool.start(5, 0.0, [&](auto&) { return remembered; }));
  ASSERT_TRUE(pool.start(6, 0.0, [&](auto&) { return large; }));
  ASSERT_TRUE(pool.start(7, 0.0, [](auto&) { return std::string(); }));
  EXPECT_FALSE(pool.has_room());
  auto ended = all_of(pool);
  EXPECT_TRUE(pool.has_room());
  EXPECT_EQ(ended[5].text, remembered);
  EXPECT_EQ(ended[6].text, large);
  EXPECT_EQ(ended[7].text, "");
  EXPECT_EQ(ended[7].end, ProcessEnd::kReturned);
}

TEST(ProcessPool, SaysByWhatAProcessCrashed) {
  ProcessPool pool(3);
  ASSERT_TRUE(pool.start(1, 0.0, [](auto&) {
    std::raise(SIGKILL);
    return std::string();
  }));
  ASSERT_TRUE(pool.start(2, 0.0, [](auto&) -> std::string { throw std::runtime_error("no way"); }));
  ASSERT_TRUE(pool.start(3, 0.0, [](auto&) -> std::string { ::_exit(3); }));
  auto ended = all_of(pool);
  for (const auto& [key, each] : ended) EXPECT_EQ(each.end, ProcessEnd::kCrashed) << key;
  EXPECT_EQ(ended[1].text, "signal 9 (Killed)");
  EXPECT_EQ(ended[2].text, "exception: no way");
  EXPECT_EQ(ended[3].text, "ended by itself with status 3");
}

TEST(ProcessPool, EndsWhatTakesTooLongAndNothingElse) {
  ProcessPool pool(2);
  ASSERT_TRUE(pool.start(1, 0.05, [](auto&) {
    while (true) ::pause();
    return std::string();
  }));
  ASSERT_TRUE(pool.start(2, 60.0, [](auto&) { return std::string("in time"); }));
  auto ended = all_of(pool);
  EXPECT_EQ(ended[1].end, ProcessEnd::kTimedOut);
  EXPECT_EQ(ended[2].text, "in time");
}

TEST(ProcessPool, LeavesNoProcessBehind) {
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  {
    ProcessPool pool(1);
    ASSERT_TRUE(pool.start(1, 0.0, [](auto&) {
      while (true) ::pause();
      return std::string();
    }));
  }
  ::close(ends[1]);
  char nothing = 0;
  EXPECT_EQ(::read(ends[0], &nothing, 1), 0) << "somebody still holds the pipe's other end";
  ::close(ends[0]);
}

}  // namespace
}  // namespace aims
