// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "core/stopwatch.hpp"
#include "live/transport.hpp"

namespace aims {

/// Ways to start anew.
enum class LiveRequest {
  kReset,      ///< start anew, at the origin
  kCalibrate,  ///< start anew where it is: the robot stands, gravity and gyro bias are averaged
};

/// Requests to a running estimate: std_msgs/String on ~command ("reset", "calibrate", "save_map"),
/// or a signal, SIGUSR1 to save the map, SIGUSR2 to calibrate.
class Commands {
 public:
  /// Subscribes, and takes the signals of the process.
  explicit Commands(Transport& transport);

  /// The next message that is no command, as `Transport::wait`.
  std::optional<LiveMessage> wait(double seconds);

  /// Whether the estimate is to start anew.
  bool restarts() const { return restart_.has_value(); }
  /// The request to start anew, once; none: there is none.
  std::optional<LiveRequest> take_restart() { return std::exchange(restart_, {}); }
  /// What saves the map, called by `wait`; empty: there is no map yet.
  void on_save_map(std::function<void()> save) { save_ = std::move(save); }
  /// What is told each second in which no message comes, how long none came [s]; empty: nobody.
  void on_silence(std::function<void(double)> tell) { silence_ = std::move(tell); }

 private:
  void take(const LiveMessage& message);
  void take_signals();
  void save_map() const;
  void note_silence(bool silent);

  Transport& transport_;
  std::string topic_;
  std::optional<LiveRequest> restart_;
  std::function<void()> save_;
  std::function<void(double)> silence_;
  Stopwatch since_message_;
  double told_ = 0.0;  ///< of the silence [s]
};

}  // namespace aims
