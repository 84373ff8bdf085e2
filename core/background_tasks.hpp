// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace aims {

/// Does tasks one after another, in the order given, while the caller goes on. The thread that does
/// them lives from the first task to wait(): between, the process may be forked.
class BackgroundTasks {
 public:
  /// With one thread, a task is done when it is given.
  explicit BackgroundTasks(int threads) : threaded_(threads > 1) {}
  BackgroundTasks(const BackgroundTasks&) = delete;
  BackgroundTasks& operator=(const BackgroundTasks&) = delete;
  /// Waits for the tasks.
  ~BackgroundTasks();

  void add(std::function<void()> task);

  /// Returns when every task is done. Throws what a task threw; those after it are left undone.
  void wait();

 private:
  void work();
  void join();

  bool threaded_;
  std::thread thread_;
  std::mutex mutex_;  ///< of all below
  std::condition_variable changed_;
  std::deque<std::function<void()>> tasks_;
  bool last_given_ = false;  ///< no more tasks will come
  std::exception_ptr thrown_;
};

}  // namespace aims
