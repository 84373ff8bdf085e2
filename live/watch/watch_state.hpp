// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/lie.hpp"
#include "core/time.hpp"
#include "live/inbox.hpp"
#include "recordings/messages/message_decoder.hpp"

namespace aims {

/// What a live estimate has published, as JSON for a page. For several threads.
class WatchState {
 public:
  explicit WatchState(std::string node) : node_(std::move(node)) {}

  /// Takes an odometry, a cloud or diagnostics; what is none, or broken, is counted.
  void take(const LiveMessage& message);

  /// {"node", "silent_s", "pose": [x, y, z, heading], "path": {"epoch", "from", "xy"}, "scan": [x,
  /// y, z, ...] [cm], "health": {"level", "text", "values"}, "malformed"}. The path [m] begins at
  /// point `from` when `epoch` is the present one, else at its start.
  std::string json(std::uint64_t epoch, std::size_t from) const;

 private:
  bool take_odometry(const MessageView& view, std::int64_t arrival);
  bool take_cloud(const MessageView& view);
  bool take_diagnostics(const MessageView& view);

  std::string node_;
  std::map<std::string, Result<MessageDecoder>> decoders_;  ///< by type

  mutable std::mutex mutex_;  ///< of what follows
  std::optional<Pose> pose_;
  std::int64_t last_ = 0;  ///< arrival of the last odometry
  std::vector<std::array<double, 2>> path_;
  std::uint64_t epoch_ = 0;  ///< of the path: grows when points were removed
  std::vector<int> scan_;    ///< [cm]
  int level_ = 3;            ///< of DiagnosticStatus
  std::string health_;
  std::vector<std::pair<std::string, std::string>> values_;
  std::size_t malformed_ = 0;
};

}  // namespace aims
