// SPDX-License-Identifier: BSD-3-Clause
#include "render/film/ffmpeg.hpp"

#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

// After <unistd.h>, which declares `environ`.
#include <fcntl.h>
#include <spawn.h>

#include "core/text.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

/// A file descriptor that closes itself.
class Descriptor {
 public:
  explicit Descriptor(int number = -1) : number_(number) {}
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  ~Descriptor() { close(); }
  void close() {
    if (number_ >= 0) ::close(number_);
    number_ = -1;
  }
  int number() const { return number_; }

 private:
  int number_;
};

std::vector<std::string> arguments_of(const fs::path& ffmpeg, const fs::path& file,
                                      const Movie& movie) {
  std::vector<std::string> arguments = {ffmpeg.string(),
                                        "-loglevel",
                                        "error",
                                        "-y",
                                        "-f",
                                        "rawvideo",
                                        "-pix_fmt",
                                        "rgb24",
                                        "-s",
                                        fmt::format("{}x{}", movie.width, movie.height),
                                        "-r",
                                        fmt::format("{}", movie.frame_rate),
                                        "-i",
                                        "pipe:0",
                                        "-an",
                                        "-map_metadata",
                                        "-1",
                                        "-fflags",
                                        "+bitexact",
                                        "-flags:v",
                                        "+bitexact",
                                        "-pix_fmt",
                                        "yuv420p"};
  const std::vector<std::string> mp4 = {"-c:v",      "libx264",    "-crf", "20",
                                        "-movflags", "+faststart", "-f",   "mp4"};
  const std::vector<std::string> webm = {"-c:v", "libvpx-vp9", "-crf", "30",
                                         "-b:v", "0",          "-f",   "webm"};
  const auto& codec = file.extension() == ".webm" ? webm : mp4;
  arguments.insert(arguments.end(), codec.begin(), codec.end());
  arguments.push_back(file.string() + ".part");
  return arguments;
}

/// A started ffmpeg: frames go to `input`, its error messages come from `complaints`.
struct Encoder {
  pid_t process = -1;
  Descriptor input;
  Descriptor complaints;
};

Result<Encoder> start(const std::vector<std::string>& arguments) {
  std::array<int, 2> frames{};
  std::array<int, 2> errors{};
  // A socket, since writing to a broken one is an error where a pipe's is a signal.
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, frames.data()) != 0) {
    return failure("cannot start ffmpeg: no socket");
  }
  const Descriptor frames_end(frames[1]);
  Encoder encoder;
  encoder.input = Descriptor(frames[0]);
  if (pipe2(errors.data(), O_CLOEXEC) != 0) return failure("cannot start ffmpeg: no pipe");
  encoder.complaints = Descriptor(errors[0]);
  const Descriptor errors_end(errors[1]);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, frames_end.number(), STDIN_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, errors_end.number(), STDERR_FILENO);
  std::vector<char*> words;
  for (const std::string& word : arguments) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  const int code =
      posix_spawn(&encoder.process, words[0], &actions, nullptr, words.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (code != 0) {
    return failure("cannot start ffmpeg: " + std::generic_category().message(code));
  }
  return encoder;
}

/// False when ffmpeg reads no more.
bool send_all(int socket, const std::vector<std::uint8_t>& bytes) {
  std::size_t sent = 0;
  while (sent < bytes.size()) {
    const ssize_t now = ::send(socket, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
    if (now < 0 && errno == EINTR) continue;
    if (now <= 0) return false;
    sent += static_cast<std::size_t>(now);
  }
  return true;
}

Result<void> send_frames(const Encoder& encoder, const Movie& movie) {
  const int stays =
      std::max(1, static_cast<int>(std::lround(movie.last_frame_s * movie.frame_rate)));
  for (int frame = 0; frame < movie.frames; ++frame) {
    const auto picture = movie.draw(frame);
    if (!picture) return tl::unexpected(picture.error());
    const int times = frame + 1 == movie.frames ? stays : 1;
    for (int i = 0; i < times; ++i) {
      if (!send_all(encoder.input.number(), picture->rgb))
        return {};  // its exit code reports the failure
    }
  }
  return {};
}

std::string read_all(int descriptor) {
  std::string text;
  std::array<char, 4096> buffer{};
  for (ssize_t now = 0; (now = ::read(descriptor, buffer.data(), buffer.size())) > 0;) {
    text.append(buffer.data(), static_cast<std::size_t>(now));
  }
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text;
}

}  // namespace

std::optional<fs::path> find_ffmpeg() {
  const char* path = std::getenv("PATH");
  for (const std::string& folder : split(path == nullptr ? "" : path, ':')) {
    const fs::path program = fs::path(folder) / "ffmpeg";
    if (!folder.empty() && access(program.c_str(), X_OK) == 0) return program;
  }
  return std::nullopt;
}

Result<void> write_with_ffmpeg(const fs::path& ffmpeg, const fs::path& file, const Movie& movie) {
  if (file.extension() != ".mp4" && file.extension() != ".webm") {
    return failure(file.string() + ": expected a file name ending in .mp4 or .webm");
  }
  if (movie.width % 2 != 0 || movie.height % 2 != 0) {
    return failure(fmt::format("{}: expected an even width and height, not {} x {}", file.string(),
                               movie.width, movie.height));
  }
  auto encoder = start(arguments_of(ffmpeg, file, movie));
  if (!encoder) return tl::unexpected(encoder.error());
  const auto sent = send_frames(*encoder, movie);
  encoder->input.close();
  const std::string complaints = read_all(encoder->complaints.number());
  int status = 0;
  waitpid(encoder->process, &status, 0);
  const fs::path partial = file.string() + ".part";
  std::error_code code;
  const bool done = sent && WIFEXITED(status) && WEXITSTATUS(status) == 0;
  if (done) fs::rename(partial, file, code);
  if (done && !code) return {};
  std::error_code ignored;
  fs::remove(partial, ignored);
  if (!sent) return sent;
  return failure(
      fmt::format("{}: ffmpeg failed: {}", file.string(), code ? code.message() : complaints));
}

}  // namespace aims
