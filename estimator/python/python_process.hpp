// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/measurements.hpp"

namespace aims {

/// Version of the messages between the program and estimator/python/worker.py.
inline constexpr int kPythonProtocol = 3;

/// Kinds of messages to the process; each is answered by one of `PythonReply`.
enum class PythonRequest : std::uint64_t { kHello = 1, kCreate = 2, kMeasure = 3, kFinish = 4 };
enum class PythonReply : std::uint64_t { kError = 0, kDescription = 1, kDone = 2, kPoses = 3 };

/// Bytes of a message, written one value after the other, little endian.
class PipeMessage {
 public:
  template <class Value>
  void add(const Value& value) {
    const auto* bytes = reinterpret_cast<const std::byte*>(&value);
    bytes_.insert(bytes_.end(), bytes, bytes + sizeof(Value));
  }
  /// Length and UTF-8.
  void add_text(const std::string& text);
  /// The rows of a (4, 4) matrix.
  void add_pose(const Pose& pose);
  void pad_to_eight() { bytes_.resize((bytes_.size() + 7) / 8 * 8); }
  void append(std::span<const std::byte> bytes) {
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  }
  std::span<const std::byte> bytes() const { return bytes_; }
  void clear() { bytes_.clear(); }

 private:
  std::vector<std::byte> bytes_;
};

/// What a message holds, read one value after the other; one that is too short is an error.
class MessageCursor {
 public:
  explicit MessageCursor(std::span<const std::byte> bytes) : bytes_(bytes) {}

  template <class Value>
  Value take() {
    Value value{};
    take_bytes(&value, sizeof(Value));
    return value;
  }
  std::string take_text();
  bool at_end() const { return bytes_.empty() || short_; }
  bool is_short() const { return short_; }
  std::size_t left() const { return bytes_.size(); }

 private:
  void take_bytes(void* to, std::size_t size);

  std::span<const std::byte> bytes_;
  bool short_ = false;
};

/// The call of the class that the process has begun last.
struct PythonCall {
  std::uint64_t count = 0;    ///< calls begun so far
  std::string method;         ///< "import", "constructor" or its name; empty before the first
  std::optional<Time> stamp;  ///< of the measurement that it was handed
};

/// Memory that both processes map: one page for the call that runs, then points in parts of one
/// scan each. Layout of a point: that of `LidarPoint`.
class SharedMemory {
 public:
  /// A part as the process finds it.
  struct Part {
    std::uint64_t offset = 0;    ///< in the file [bytes]
    std::uint64_t capacity = 0;  ///< [bytes]
    void* memory = nullptr;
    bool in_use = false;  ///< the estimator may still read it
  };

  SharedMemory() = default;
  SharedMemory(const SharedMemory&) = delete;
  SharedMemory& operator=(const SharedMemory&) = delete;
  ~SharedMemory();

  Result<void> create();
  int descriptor() const { return file_; }

  /// As the process states it before each call.
  PythonCall call() const;

  /// Copies the points into a part that is not in use, which is then.
  Result<Part> put(const std::vector<LidarPoint>& points);

  /// Sets which parts are in use, by their offsets.
  void keep(std::span<const std::uint64_t> offsets);

 private:
  Result<Part*> part_for(std::uint64_t bytes);
  Result<void*> add(std::uint64_t bytes);

  int file_ = -1;
  const std::byte* call_ = nullptr;
  std::uint64_t size_ = 0;
  std::vector<Part> parts_;
};

/// A Python interpreter that runs worker.py on one class. It ends with this object, and with the
/// thread that started it. Its standard output goes to standard error.
class PythonProcess {
 public:
  PythonProcess() = default;
  PythonProcess(const PythonProcess&) = delete;
  PythonProcess& operator=(const PythonProcess&) = delete;
  ~PythonProcess();

  /// Starts $AIMS_PYTHON, else `python3`. Error when there is no such program.
  Result<void> start();

  /// Sends a request and waits for its answer, whose content is returned. Error when the estimator
  /// raised one (step, error and traceback), the process has ended (by which signal or code), or
  /// one call of the class takes longer than `limit_s` of wall time, 0: any (method, stamp, limit,
  /// and the traceback of a call that Python can interrupt; the process has then ended).
  Result<std::vector<std::byte>> ask(PythonRequest request, std::span<const std::byte> content,
                                     double limit_s);

  /// What the request that failed had yielded before, in the form of its answer; may be empty.
  std::span<const std::byte> yielded() const { return yielded_; }

  SharedMemory& memory() { return memory_; }

 private:
  struct Answer {
    PythonReply kind = PythonReply::kError;
    std::vector<std::byte> content;
  };

  Result<Answer> receive();
  Result<std::vector<std::byte>> content_of(Answer answer);
  Result<std::vector<std::byte>> interrupt(double limit_s);
  bool has_ended() const;
  bool answers_within(double limit_s) const;
  Error ended();
  void stop();

  pid_t pid_ = -1;
  int socket_ = -1;
  std::vector<std::byte> yielded_;
  SharedMemory memory_;
};

}  // namespace aims
