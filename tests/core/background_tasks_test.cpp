// SPDX-License-Identifier: BSD-3-Clause
#include "core/background_tasks.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <stdexcept>
#include <vector>

namespace aims {
namespace {

class BackgroundTasksOn : public ::testing::TestWithParam<int> {};

TEST_P(BackgroundTasksOn, AreDoneInTheirOrderBeforeWaitReturns) {
  BackgroundTasks tasks(GetParam());
  std::vector<int> done;
  std::vector<int> expected(3000);
  std::iota(expected.begin(), expected.end(), 0);
  for (int round = 0; round < 3; ++round) {
    for (int i = 1000 * round; i < 1000 * (round + 1); ++i) {
      tasks.add([&done, i] { done.push_back(i); });
    }
    tasks.wait();
    ASSERT_EQ(done.size(), 1000U * (round + 1));
  }
  EXPECT_EQ(done, expected);
  tasks.wait();  // nothing to wait for
}

TEST_P(BackgroundTasksOn, AreDoneBeforeTheirEnd) {
  std::vector<int> done;
  {
    BackgroundTasks tasks(GetParam());
    for (int i = 0; i < 100; ++i) tasks.add([&done, i] { done.push_back(i); });
  }
  EXPECT_EQ(done.size(), 100U);
}

INSTANTIATE_TEST_SUITE_P(Threads, BackgroundTasksOn, ::testing::Values(1, 2));

TEST(BackgroundTasks, WorkWhileTheCallerGoesOn) {
  BackgroundTasks tasks(2);
  std::mutex held;
  held.lock();
  bool done = false;
  tasks.add([&] {
    const std::lock_guard lock(held);
    done = true;
  });
  EXPECT_FALSE(done);  // and had it been done within add(), that would never have returned
  held.unlock();
  tasks.wait();
  EXPECT_TRUE(done);
}

TEST(BackgroundTasks, WhatATaskThrowsComesFromWaitAndEndsTheLine) {
  BackgroundTasks tasks(2);
  int done = 0;
  tasks.add([&] { ++done; });
  tasks.add([] { throw std::runtime_error("full"); });
  tasks.add([&] { ++done; });
  EXPECT_THROW(tasks.wait(), std::runtime_error);
  EXPECT_EQ(done, 1);
  tasks.add([&] { ++done; });
  tasks.wait();
  EXPECT_EQ(done, 2);
}

}  // namespace
}  // namespace aims
