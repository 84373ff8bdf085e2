// SPDX-License-Identifier: BSD-3-Clause
#include "core/background_tasks.hpp"

#include <utility>

namespace aims {

BackgroundTasks::~BackgroundTasks() { join(); }

void BackgroundTasks::add(std::function<void()> task) {
  if (!threaded_) return task();
  {
    const std::lock_guard lock(mutex_);
    tasks_.push_back(std::move(task));
  }
  changed_.notify_one();
  if (!thread_.joinable()) thread_ = std::thread([this] { work(); });
}

void BackgroundTasks::wait() {
  join();
  if (auto thrown = std::exchange(thrown_, nullptr)) std::rethrow_exception(thrown);
}

void BackgroundTasks::join() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    last_given_ = true;
  }
  changed_.notify_one();
  thread_.join();
  last_given_ = false;
}

void BackgroundTasks::work() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return !tasks_.empty() || last_given_; });
    if (tasks_.empty()) return;
    const std::function<void()> task = std::move(tasks_.front());
    tasks_.pop_front();
    if (thrown_) continue;
    lock.unlock();
    std::exception_ptr thrown;
    try {
      task();
    } catch (...) {
      thrown = std::current_exception();
    }
    lock.lock();
    thrown_ = thrown;
  }
}

}  // namespace aims
