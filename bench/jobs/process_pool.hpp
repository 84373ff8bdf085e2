// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/types.h>

#include <atomic>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/stopwatch.hpp"

namespace aims {

/// How a process ended.
enum class ProcessEnd { kReturned, kCrashed, kTimedOut };

struct EndedProcess {
  std::size_t key = 0;  ///< as given to `start`
  ProcessEnd end = ProcessEnd::kReturned;
  std::string text;      ///< what the work returned; of a crash, by what
  double seconds = 0.0;  ///< wall time
};

/// Runs functions in processes of their own, copies of the calling one: they see all that it had in
/// memory, and nothing of them but the returned text, and how far they are, comes back. None
/// outlives the pool, nor the calling process however that ends. The calling process must have no
/// other thread at work.
class ProcessPool {
 public:
  /// What a process does; it may set how much of it is done, in [0, 1].
  using Work = std::function<std::string(std::atomic<double>& part)>;

  explicit ProcessPool(int size);
  ProcessPool(const ProcessPool&) = delete;
  ProcessPool& operator=(const ProcessPool&) = delete;
  ~ProcessPool();

  bool has_room() const { return running_.size() < parts_.size(); }
  bool is_idle() const { return running_.empty(); }
  /// A process that has not ended: how much it has done in which time.
  struct UnderWay {
    std::size_t key = 0;  ///< as given to `start`
    double part = 0.0;    ///< in [0, 1]
    double seconds = 0.0;
  };
  std::vector<UnderWay> under_way() const;
  /// Sum over the processes of how much each has done.
  double part_under_way() const;

  /// Starts `work`, which is ended after `timeout_s` [s] of wall time, 0: never. What it throws
  /// counts as a crash. Error when the system gives no process.
  Result<void> start(std::size_t key, double timeout_s, const Work& work);

  /// Waits until a process ends, at most `patience_s` [s]; those that have ended.
  std::vector<EndedProcess> wait(double patience_s);

 private:
  struct Running {
    std::size_t key = 0;
    pid_t pid = -1;
    std::size_t part = 0;  ///< index of how far it is
    int pipe = -1;         ///< its text comes here; it ends with the process
    double timeout_s = 0.0;
    Stopwatch stopwatch;
    std::string text;
    bool timed_out = false;
  };

  /// True once the process has nothing more to say.
  static bool read_text(Running& running);
  static EndedProcess reap(Running& running);
  void stop_late();
  int poll_time_ms(double patience_s) const;

  std::span<std::atomic<double>> parts_;  ///< shared with the processes
  std::vector<Running> running_;
};

}  // namespace aims
