// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/python/python_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>

#include "core/text.hpp"
#include "estimator/python/worker_source.hpp"

namespace aims {
namespace {

/// A mapping begins at a multiple of this, on all machines in use [bytes].
constexpr std::uint64_t kPage = 65'536;
/// Of the call that runs, in the first page: its count, whether it has a stamp, the stamp, the
/// name.
constexpr std::size_t kMethodAt = 24;
constexpr std::size_t kMethodSize = 16;
/// Time in which an interrupted class answers with its traceback [s].
constexpr double kGrace = 2.0;
/// Longest answer: a map of 100 million points [bytes].
constexpr std::uint64_t kMaxAnswer = 1'200'000'000;

bool send_all(int socket, const void* data, std::size_t size) {
  const auto* at = static_cast<const std::byte*>(data);
  while (size > 0) {
    const ssize_t sent = ::send(socket, at, size, MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) return false;
    at += sent;
    size -= static_cast<std::size_t>(sent);
  }
  return true;
}

bool receive_all(int socket, void* data, std::size_t size) {
  auto* at = static_cast<std::byte*>(data);
  while (size > 0) {
    const ssize_t got = ::recv(socket, at, size, 0);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    at += got;
    size -= static_cast<std::size_t>(got);
  }
  return true;
}

/// The interpreter: a path, or a name that is looked up in PATH.
std::string interpreter() {
  const char* named = std::getenv("AIMS_PYTHON");
  return named != nullptr && *named != '\0' ? named : "python3";
}

/// Whether there is something to read within the time [ms]; -1: any.
bool readable_within(int socket, int milliseconds) {
  pollfd waiting{socket, POLLIN, 0};
  int ready = 0;
  do {
    ready = ::poll(&waiting, 1, milliseconds);
  } while (ready < 0 && errno == EINTR);
  return ready != 0;  // an error is that of reading
}

constexpr int kNotStarted = 127;
constexpr int kNoNumpy = 126;
constexpr std::size_t kMaxSummary = 1'000, kMaxTrace = 20'000;  ///< of an exception [bytes]

/// At most so many bytes of a text, without control characters but line ends and tabs.
std::string bounded(const std::string& text, std::size_t most) {
  std::string out;
  for (const char c : text) {
    if (out.size() >= most) return out + " ...";
    const auto byte = static_cast<unsigned char>(c);
    const bool plain = (byte >= 0x20 && byte != 0x7f) || c == '\n' || c == '\t';
    out += plain ? std::string(1, c) : fmt::format("\\x{:02x}", byte);
  }
  return out;
}

/// The life of the new process up to its program: nothing here takes memory or locks, as other
/// threads of the calling process may hold some.
[[noreturn]] void become(pid_t parent, char* const* arguments, char* const* environment,
                         std::span<const int> kept) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  ::setpgid(0, 0);  // its children are ended with it
  if (::getppid() != parent) ::_exit(kNotStarted);
  ::dup2(STDERR_FILENO, STDOUT_FILENO);
  for (const int descriptor : kept) ::fcntl(descriptor, F_SETFD, 0);
  ::execvpe(arguments[0], arguments, environment);
  ::_exit(kNotStarted);
}

/// The environment with settings that make results repeat, unless the user has others.
std::vector<std::string> worker_environment() {
  std::vector<std::string> all;
  for (char** each = environ; *each != nullptr; ++each) all.emplace_back(*each);
  for (const char* setting :
       {"PYTHONHASHSEED=0", "OMP_NUM_THREADS=1", "OPENBLAS_NUM_THREADS=1", "MKL_NUM_THREADS=1"}) {
    const std::string name(setting, std::strchr(setting, '='));
    if (std::getenv(name.c_str()) == nullptr) all.emplace_back(setting);
  }
  return all;
}

/// The texts as exec takes them, ended by a null pointer.
std::vector<char*> pointers_to(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  for (std::string& each : texts) pointers.push_back(each.data());
  pointers.push_back(nullptr);
  return pointers;
}

std::string text_of_status(int status) {
  if (WIFSIGNALED(status)) {
    return fmt::format("ended by signal {} ({})", WTERMSIG(status), ::strsignal(WTERMSIG(status)));
  }
  if (WEXITSTATUS(status) == kNotStarted) {
    return fmt::format("no Python interpreter '{}'; AIMS_PYTHON names another", interpreter());
  }
  if (WEXITSTATUS(status) == kNoNumpy) {
    return fmt::format(
        "'{}' has no NumPy; AIMS_PYTHON names an interpreter that has it, e.g. "
        "AIMS_PYTHON=/usr/bin/python3 after apt install python3-numpy",
        interpreter());
  }
  return fmt::format("ended by itself with status {}", WEXITSTATUS(status));
}

}  // namespace

void PipeMessage::add_text(const std::string& text) {
  add(std::uint64_t{text.size()});
  append(std::as_bytes(std::span(text)));
}

void PipeMessage::add_pose(const Pose& pose) {
  const Eigen::Matrix3d R = pose.R();
  for (int row = 0; row < 3; ++row) {
    for (int at = 0; at < 3; ++at) add(R(row, at));
    add(pose.translation[row]);
  }
  for (const double value : {0.0, 0.0, 0.0, 1.0}) add(value);
}

void MessageCursor::take_bytes(void* to, std::size_t size) {
  short_ = short_ || bytes_.size() < size;
  if (short_) return;
  std::memcpy(to, bytes_.data(), size);
  bytes_ = bytes_.subspan(size);
}

std::string MessageCursor::take_text() {
  const auto size = take<std::uint64_t>();
  short_ = short_ || bytes_.size() < size;
  if (short_) return {};
  std::string text(size, '\0');
  take_bytes(text.data(), size);
  return text;
}

SharedMemory::~SharedMemory() {
  for (const Part& part : parts_) ::munmap(part.memory, part.capacity);
  if (call_ != nullptr) ::munmap(const_cast<std::byte*>(call_), kPage);
  if (file_ >= 0) ::close(file_);
}

Result<void> SharedMemory::create() {
  file_ = ::memfd_create("aims_points", MFD_CLOEXEC | MFD_ALLOW_SEALING);
  // Memory behind the end of a file that Python shortens would end this process.
  if (file_ >= 0) ::fcntl(file_, F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_SEAL);
  const auto page = add(kPage);
  if (!page) return tl::unexpected(page.error());
  call_ = static_cast<const std::byte*>(*page);
  return {};
}

PythonCall SharedMemory::call() const {
  MessageCursor cursor(std::span(call_, kMethodAt));
  PythonCall call;
  call.count = cursor.take<std::uint64_t>();
  const bool has_stamp = cursor.take<std::uint64_t>() != 0;
  const auto stamp = cursor.take<Time>();
  if (has_stamp) call.stamp = stamp;
  const auto* method = reinterpret_cast<const char*>(call_ + kMethodAt);
  call.method.assign(method, ::strnlen(method, kMethodSize));
  return call;
}

Result<SharedMemory::Part> SharedMemory::put(const std::vector<LidarPoint>& points) {
  if (points.empty()) return Part();
  const std::uint64_t bytes = points.size() * sizeof(LidarPoint);
  const auto part = part_for(bytes);
  if (!part) return tl::unexpected(part.error());
  (*part)->in_use = true;
  std::memcpy((*part)->memory, points.data(), bytes);
  return **part;
}

void SharedMemory::keep(std::span<const std::uint64_t> offsets) {
  for (Part& part : parts_) {
    part.in_use = std::find(offsets.begin(), offsets.end(), part.offset) != offsets.end();
  }
}

Result<SharedMemory::Part*> SharedMemory::part_for(std::uint64_t bytes) {
  for (Part& part : parts_) {
    if (!part.in_use && part.capacity >= bytes) return &part;
  }
  Part part;
  part.offset = size_;
  part.capacity = (bytes + bytes / 4 + kPage - 1) / kPage * kPage;
  const auto memory = add(part.capacity);
  if (!memory) return tl::unexpected(memory.error());
  part.memory = *memory;
  parts_.push_back(part);
  return &parts_.back();
}

Result<void*> SharedMemory::add(std::uint64_t bytes) {
  void* memory = MAP_FAILED;
  if (file_ >= 0 && ::ftruncate(file_, static_cast<off_t>(size_ + bytes)) == 0) {
    memory = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file_,
                    static_cast<off_t>(size_));
  }
  if (memory == MAP_FAILED) {
    return failure(fmt::format("no memory to share with Python: {}", std::strerror(errno)));
  }
  size_ += bytes;
  return memory;
}

PythonProcess::~PythonProcess() { stop(); }

void PythonProcess::stop() {
  if (socket_ >= 0) ::close(socket_);
  if (pid_ > 0) {
    ::kill(-pid_, SIGKILL);  // the group: Python and its children
    ::kill(pid_, SIGKILL);   // before it has made one
    while (::waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) continue;
  }
  socket_ = -1;
  pid_ = -1;
}

Result<void> PythonProcess::start() {
  if (auto made = memory_.create(); !made) return made;
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    return failure(fmt::format("no socket to Python: {}", std::strerror(errno)));
  }
  std::vector<std::string> words = {interpreter(), "-c", std::string(kPythonWorker),
                                    std::to_string(ends[1]), std::to_string(memory_.descriptor())};
  std::vector<std::string> settings = worker_environment();
  const std::vector<char*> arguments = pointers_to(words);
  const std::vector<char*> environment = pointers_to(settings);
  const std::array<int, 2> kept = {ends[1], memory_.descriptor()};
  const pid_t parent = ::getpid();
  pid_ = ::fork();
  if (pid_ == 0) become(parent, arguments.data(), environment.data(), kept);
  const int error = errno;
  ::close(ends[1]);
  socket_ = ends[0];
  if (pid_ > 0) return {};
  return failure(fmt::format("no process for Python: {}", std::strerror(error)));
}

Error PythonProcess::ended() {
  int status = 0;
  siginfo_t info{};
  while (pid_ > 0 && ::waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOWAIT) < 0 &&
         errno == EINTR) {
    continue;
  }
  if (pid_ > 0) ::kill(-pid_, SIGKILL);  // what it has left; the group is its own until it is read
  while (pid_ > 0 && ::waitpid(pid_, &status, 0) < 0 && errno == EINTR) continue;
  pid_ = -1;
  return {text_of_status(status)};
}

Result<std::vector<std::byte>> PythonProcess::ask(PythonRequest request,
                                                  std::span<const std::byte> content,
                                                  double limit_s) {
  const std::array<std::uint64_t, 2> header = {static_cast<std::uint64_t>(request), content.size()};
  const bool sent = send_all(socket_, header.data(), sizeof(header)) &&
                    send_all(socket_, content.data(), content.size());
  if (!sent) return tl::unexpected(ended());
  if (!answers_within(limit_s)) return interrupt(limit_s);
  auto answer = receive();
  if (!answer) return tl::unexpected(answer.error());
  return content_of(std::move(*answer));
}

Result<PythonProcess::Answer> PythonProcess::receive() {
  std::array<std::uint64_t, 2> header{};
  if (!receive_all(socket_, header.data(), sizeof(header))) return tl::unexpected(ended());
  if (header[1] > kMaxAnswer) return failure(fmt::format("answered with {} bytes", header[1]));
  Answer answer{static_cast<PythonReply>(header[0]), std::vector<std::byte>(header[1])};
  if (!receive_all(socket_, answer.content.data(), header[1])) return tl::unexpected(ended());
  return answer;
}

Result<std::vector<std::byte>> PythonProcess::content_of(Answer answer) {
  if (answer.kind != PythonReply::kError) return std::move(answer.content);
  MessageCursor cursor(answer.content);
  const std::string step = bounded(cursor.take_text(), kMaxSummary);
  const std::string summary = bounded(cursor.take_text(), kMaxSummary);
  const std::string trace = bounded(cursor.take_text(), kMaxTrace);
  yielded_.assign(answer.content.end() - static_cast<std::ptrdiff_t>(cursor.left()),
                  answer.content.end());
  const bool repeated = trace.starts_with(summary) && trace.size() <= summary.size() + 1;
  return failure(repeated ? fmt::format("{}: {}", step, summary)
                          : fmt::format("{}: {}\n{}", step, summary, trace));
}

/// Whether the process is dead; its status stays to be read.
bool PythonProcess::has_ended() const {
  siginfo_t info{};
  const int options = WEXITED | WNOHANG | WNOWAIT;
  return ::waitid(P_PID, static_cast<id_t>(pid_), &info, options) == 0 && info.si_pid == pid_;
}

/// Counted in slices, so that time in which both processes are stopped does not count.
bool PythonProcess::answers_within(double limit_s) const {
  const bool limited = limit_s > 0.0;
  const auto limit_ms = limited ? std::max(1, static_cast<int>(1e3 * limit_s)) : 10'000;
  const int slice_ms = std::clamp(limit_ms / 10, 1, 1'000);
  std::uint64_t count = memory_.call().count;
  for (int waited_ms = 0; waited_ms < limit_ms; waited_ms += slice_ms) {
    if (readable_within(socket_, slice_ms)) return true;
    if (has_ended()) {
      // Its children may hold the other end: nothing more is to come.
      ::shutdown(socket_, SHUT_RD);
      return true;
    }
    const std::uint64_t begun = memory_.call().count;
    if (begun != count || !limited) waited_ms = -slice_ms;
    count = begun;
  }
  return false;
}

/// An answer that comes after all is taken.
Result<std::vector<std::byte>> PythonProcess::interrupt(double limit_s) {
  const PythonCall call = memory_.call();
  ::kill(pid_, SIGUSR1);
  std::string trace;
  if (readable_within(socket_, static_cast<int>(1e3 * kGrace))) {
    auto answer = receive();
    if (answer && answer->kind != PythonReply::kError) return std::move(answer->content);
    if (answer) trace = content_of(std::move(*answer)).error().message;
  }
  stop();
  const std::string of =
      call.stamp ? " of the measurement at " + stamp_text(*call.stamp) + " s" : std::string();
  return failure(fmt::format("{}: the call{} has not ended within {:g} s (call_timeout){}",
                             call.method.empty() ? "start of Python" : call.method, of, limit_s,
                             trace.empty() ? "" : "\n" + trace.substr(trace.find('\n') + 1)));
}

}  // namespace aims
