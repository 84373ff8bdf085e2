// SPDX-License-Identifier: BSD-3-Clause
#include "render/results/picture_list.hpp"

#include <mutex>
#include <vector>

#include "core/background_tasks.hpp"

namespace aims {

Result<void> draw_all(std::span<const Picture> pictures, int threads,
                      const DrawObserver& observer) {
  std::vector<Result<void>> drawn(pictures.size());
  std::mutex mutex;  // of what follows, and of the observer
  std::size_t next = 0;
  bool failed = false;
  const auto draw_some = [&] {
    std::unique_lock lock(mutex);
    while (next < pictures.size() && !failed) {
      const std::size_t own = next++;
      announce(observer, pictures[own].file);
      lock.unlock();
      drawn[own] = pictures[own].draw();
      lock.lock();
      failed = failed || !drawn[own];
    }
  };
  BackgroundTasks second(threads);
  second.add(draw_some);
  draw_some();
  second.wait();
  for (const Result<void>& each : drawn) {
    if (!each) return each;
  }
  return {};
}

}  // namespace aims
