// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/python/python_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
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

#include "estimator/python/worker_source.hpp"

namespace aims {
namespace {

/// A mapping begins at a multiple of this, on all machines in use [bytes].
constexpr std::uint64_t kPage = 65'536;
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

constexpr int kNotStarted = 127;

/// The life of the new process up to its program: nothing here takes memory or locks, as other
/// threads of the calling process may hold some.
[[noreturn]] void become(pid_t parent, char* const* arguments, char* const* environment,
                         std::span<const int> kept) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
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
  return fmt::format("ended by itself with status {}", WEXITSTATUS(status));
}

}  // namespace

void MessageBytes::add_text(const std::string& text) {
  add(std::uint64_t{text.size()});
  append(std::as_bytes(std::span(text)));
}

void MessageBytes::add_pose(const Pose& pose) {
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

SharedPoints::~SharedPoints() {
  for (const Part& part : parts_) ::munmap(part.memory, part.capacity);
  if (file_ >= 0) ::close(file_);
}

Result<void> SharedPoints::create() {
  file_ = ::memfd_create("aims_points", MFD_CLOEXEC);
  if (file_ >= 0) return {};
  return failure(fmt::format("no memory to share with Python: {}", std::strerror(errno)));
}

Result<SharedPoints::Part> SharedPoints::put(const std::vector<LidarPoint>& points) {
  if (points.empty()) return Part();
  const std::uint64_t bytes = points.size() * sizeof(LidarPoint);
  const auto part = part_for(bytes);
  if (!part) return tl::unexpected(part.error());
  (*part)->in_use = true;
  std::memcpy((*part)->memory, points.data(), bytes);
  return **part;
}

void SharedPoints::keep(std::span<const std::uint64_t> offsets) {
  for (Part& part : parts_) {
    part.in_use = std::find(offsets.begin(), offsets.end(), part.offset) != offsets.end();
  }
}

Result<SharedPoints::Part*> SharedPoints::part_for(std::uint64_t bytes) {
  for (Part& part : parts_) {
    if (!part.in_use && part.capacity >= bytes) return &part;
  }
  Part part;
  part.offset = size_;
  part.capacity = (bytes + bytes / 4 + kPage - 1) / kPage * kPage;
  const auto new_size = static_cast<off_t>(size_ + part.capacity);
  if (::ftruncate(file_, new_size) == 0) {
    part.memory = ::mmap(nullptr, part.capacity, PROT_READ | PROT_WRITE, MAP_SHARED, file_,
                         static_cast<off_t>(part.offset));
  }
  if (part.memory == nullptr || part.memory == MAP_FAILED) {
    return failure(fmt::format("no memory to share with Python: {}", std::strerror(errno)));
  }
  size_ += part.capacity;
  parts_.push_back(part);
  return &parts_.back();
}

PythonProcess::~PythonProcess() { stop(); }

void PythonProcess::stop() {
  if (socket_ >= 0) ::close(socket_);
  if (pid_ > 0) {
    ::kill(pid_, SIGKILL);
    while (::waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) continue;
  }
  socket_ = -1;
  pid_ = -1;
}

Result<void> PythonProcess::start() {
  if (auto made = points_.create(); !made) return made;
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    return failure(fmt::format("no socket to Python: {}", std::strerror(errno)));
  }
  std::vector<std::string> words = {interpreter(), "-c", std::string(kPythonWorker),
                                    std::to_string(ends[1]), std::to_string(points_.descriptor())};
  std::vector<std::string> settings = worker_environment();
  const std::vector<char*> arguments = pointers_to(words);
  const std::vector<char*> environment = pointers_to(settings);
  const std::array<int, 2> kept = {ends[1], points_.descriptor()};
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
  while (pid_ > 0 && ::waitpid(pid_, &status, 0) < 0 && errno == EINTR) continue;
  pid_ = -1;
  return {text_of_status(status)};
}

Result<std::vector<std::byte>> PythonProcess::ask(PythonRequest request,
                                                  std::span<const std::byte> content) {
  const std::array<std::uint64_t, 2> header = {static_cast<std::uint64_t>(request), content.size()};
  std::array<std::uint64_t, 2> answer{};
  const bool answered = send_all(socket_, header.data(), sizeof(header)) &&
                        send_all(socket_, content.data(), content.size()) &&
                        receive_all(socket_, answer.data(), sizeof(answer));
  if (!answered) return tl::unexpected(ended());
  if (answer[1] > kMaxAnswer) return failure(fmt::format("answered with {} bytes", answer[1]));
  std::vector<std::byte> bytes(answer[1]);
  if (!receive_all(socket_, bytes.data(), bytes.size())) return tl::unexpected(ended());
  if (answer[0] != static_cast<std::uint64_t>(PythonReply::kError)) return bytes;
  MessageCursor cursor(bytes);
  const std::string step = cursor.take_text();
  const std::string summary = cursor.take_text();
  return failure(fmt::format("{}: {}\n{}", step, summary, cursor.take_text()));
}

}  // namespace aims
