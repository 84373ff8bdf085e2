// SPDX-License-Identifier: BSD-3-Clause
#include "live/transport.hpp"

#include <atomic>
#include <csignal>
#include <utility>

namespace aims {
namespace {

std::atomic<bool> end_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free);
void request_end(int) { end_requested = true; }

}  // namespace

Transport::Transport() {
  std::signal(SIGINT, request_end);
  std::signal(SIGTERM, request_end);
  // A lost ssh connection; under nohup it stays ignored.
  if (std::signal(SIGHUP, request_end) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
}

bool Transport::running() const { return !end_requested; }

std::optional<LiveMessage> Transport::wait(double seconds) {
  return inbox_.wait(seconds, [this] { return running(); });
}

void Transport::tell(std::string problem) {
  const std::lock_guard lock(mutex_);
  if (told_.insert(problem).second) problems_.push_back(std::move(problem));
}

std::vector<std::string> Transport::take_problems() {
  const std::lock_guard lock(mutex_);
  return std::exchange(problems_, {});
}

}  // namespace aims
