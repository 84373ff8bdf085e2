// SPDX-License-Identifier: BSD-3-Clause
#include "bench/jobs/process_pool.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstring>
#include <exception>
#include <string_view>
#include <system_error>
#include <utility>

namespace aims {
namespace {

constexpr int kThrew = 70;  ///< exit status of a process whose work threw; its text is the reason

void send(int descriptor, std::string_view text) {
  while (!text.empty()) {
    const ssize_t sent = ::write(descriptor, text.data(), text.size());
    if (sent < 0 && errno == EINTR) continue;
    if (sent < 0) return;
    text.remove_prefix(static_cast<std::size_t>(sent));
  }
}

/// The life of the new process.
[[noreturn]] void live(pid_t parent, int pipe, const std::function<std::string()>& work) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(kThrew);
  // Ctrl-C goes to all of a terminal's processes: the calling one decides what becomes of it.
  std::signal(SIGINT, SIG_IGN);
  const rlimit no_core = {0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
  try {
    send(pipe, work());
  } catch (const std::exception& error) {
    send(pipe, error.what());
    ::_exit(kThrew);
  }
  ::_exit(0);  // no destructors, no buffers of the calling process
}

std::string crash_text(int status, const std::string& text) {
  if (WIFSIGNALED(status)) {
    return fmt::format("signal {} ({})", WTERMSIG(status), ::strsignal(WTERMSIG(status)));
  }
  if (WEXITSTATUS(status) == kThrew) return fmt::format("exception: {}", text);
  return fmt::format("ended by itself with status {}", WEXITSTATUS(status));
}

}  // namespace

ProcessPool::ProcessPool(int size) {
  static_assert(std::atomic<double>::is_always_lock_free, "shared between processes");
  const auto count = static_cast<std::size_t>(size);
  void* shared = ::mmap(nullptr, count * sizeof(std::atomic<double>), PROT_READ | PROT_WRITE,
                        MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (shared == MAP_FAILED) throw std::system_error(errno, std::system_category(), "mmap");
  parts_ = {static_cast<std::atomic<double>*>(shared), count};  // zero bytes are 0.0
}

ProcessPool::~ProcessPool() {
  for (const Running& each : running_) ::kill(each.pid, SIGKILL);
  for (Running& each : running_) reap(each);
  ::munmap(parts_.data(), parts_.size_bytes());
}

std::vector<ProcessPool::UnderWay> ProcessPool::under_way() const {
  std::vector<UnderWay> all;
  for (const Running& each : running_) {
    all.push_back({each.key, parts_[each.part], each.stopwatch.seconds()});
  }
  return all;
}

double ProcessPool::part_under_way() const {
  double sum = 0.0;
  for (const Running& each : running_) sum += parts_[each.part];
  return sum;
}

Result<void> ProcessPool::start(std::size_t key, double timeout_s, const Work& work) {
  std::size_t part = 0;
  const auto is_taken = [&](const Running& each) { return each.part == part; };
  while (std::any_of(running_.begin(), running_.end(), is_taken)) ++part;
  parts_[part] = 0.0;
  std::array<int, 2> ends{};
  if (::pipe(ends.data()) != 0) {
    return failure(fmt::format("no pipe to a process: {}", std::strerror(errno)));
  }
  const pid_t parent = ::getpid();
  const pid_t pid = ::fork();
  if (pid == 0) live(parent, ends[1], [&] { return work(parts_[part]); });
  const int error = errno;
  ::close(ends[1]);
  if (pid < 0) {
    ::close(ends[0]);
    return failure(fmt::format("no process can be started: {}", std::strerror(error)));
  }
  Running running;
  running.key = key;
  running.pid = pid;
  running.part = part;
  running.pipe = ends[0];
  running.timeout_s = timeout_s;
  running_.push_back(std::move(running));
  return {};
}

std::vector<EndedProcess> ProcessPool::wait(double patience_s) {
  std::vector<pollfd> polled;
  for (const Running& each : running_) polled.push_back({each.pipe, POLLIN, 0});
  ::poll(polled.data(), polled.size(), poll_time_ms(patience_s));
  stop_late();
  std::vector<EndedProcess> ended;
  std::vector<Running> left;
  for (std::size_t i = 0; i < running_.size(); ++i) {
    Running& each = running_[i];
    if (polled[i].revents != 0 && read_text(each)) {
      ended.push_back(reap(each));
    } else {
      left.push_back(std::move(each));
    }
  }
  running_ = std::move(left);
  return ended;
}

bool ProcessPool::read_text(Running& running) {
  std::array<char, 4096> buffer{};
  const ssize_t got = ::read(running.pipe, buffer.data(), buffer.size());
  if (got < 0) return errno != EINTR && errno != EAGAIN;
  running.text.append(buffer.data(), static_cast<std::size_t>(got));
  return got == 0;
}

EndedProcess ProcessPool::reap(Running& running) {
  int status = 0;
  while (::waitpid(running.pid, &status, 0) < 0 && errno == EINTR) continue;
  ::close(running.pipe);
  EndedProcess ended{running.key, ProcessEnd::kReturned, std::move(running.text),
                     running.stopwatch.seconds()};
  if (running.timed_out) {
    ended.end = ProcessEnd::kTimedOut;
  } else if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    ended.text = crash_text(status, ended.text);
    ended.end = ProcessEnd::kCrashed;
  }
  return ended;
}

void ProcessPool::stop_late() {
  for (Running& each : running_) {
    if (each.timeout_s <= 0.0 || each.timed_out || each.stopwatch.seconds() < each.timeout_s) {
      continue;
    }
    each.timed_out = true;
    ::kill(each.pid, SIGKILL);
  }
}

int ProcessPool::poll_time_ms(double patience_s) const {
  double least_s = patience_s;
  for (const Running& each : running_) {
    if (each.timeout_s <= 0.0 || each.timed_out) continue;
    least_s = std::min(least_s, std::max(0.0, each.timeout_s - each.stopwatch.seconds()));
  }
  return static_cast<int>(std::ceil(1e3 * least_s));
}

}  // namespace aims
