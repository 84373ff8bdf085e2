// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <set>
#include <string>

#include "bench/scenario/scenario.hpp"
#include "core/error.hpp"
#include "core/files/folder_lock.hpp"

namespace aims {

/// What asking for a sequence led to.
struct SequenceMade {
  bool simulated = false;              ///< now; false: it was there, or is refused
  std::optional<std::string> refusal;  ///< why the scenario cannot be simulated
};

/// What keeping a cache within its limit came to.
struct CachePruned {
  std::size_t sequences = 0;  ///< removed
  std::uintmax_t bytes = 0;   ///< of them
  std::uintmax_t left = 0;    ///< bytes of the sequences that stayed
};

/// Sequences by content: each that was ever simulated is one file, named after everything that
/// decides it (configuration of the simulation, seed, the simulator's version) and nothing else, so
/// that any number of sweeps, processes and machines may share the folder, and it may be deleted at
/// any time. What the estimators and the scores are made of does not count.
class SequenceCache {
 public:
  explicit SequenceCache(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// $XDG_CACHE_HOME/aims/sequences, else $HOME/.cache/aims/sequences, else a folder among the
  /// temporary ones.
  static std::filesystem::path default_folder();

  /// 16 hexadecimal digits: the name of the scenario's sequence on that seed.
  static std::string id_of(const Scenario& scenario, std::uint64_t seed);

  std::filesystem::path file_of(const std::string& id) const {
    return folder_ / (id + ".sequence");
  }
  bool has(const std::string& id) const;

  /// Simulates the sequence unless it is there. While another process makes it, waits. What cannot
  /// be simulated (robot in a wall, no path) is refused; error when the folder cannot be written.
  /// `observer` is called with the part that is simulated, in [0, 1]. The file does not depend on
  /// `threads`: with more than one, scans are cast and the file is written while the robot walks
  /// on.
  Result<SequenceMade> make(const Scenario& scenario, std::uint64_t seed,
                            const std::function<void(double)>& observer = {},
                            int threads = 1) const;

  /// Keeps the sequence from being pruned, by any process, as long as the lock lives, and notes
  /// that it was used now. Nothing when it is not there.
  std::optional<FolderLock> use(const std::string& id) const;

  /// Removes sequences, those that were used longest ago first, until all are `limit` bytes at
  /// most. Those with ids in `kept` stay, and so do those in use: then more than `limit` may be
  /// left.
  CachePruned prune(std::uintmax_t limit, const std::set<std::string>& kept) const;

  const std::filesystem::path& path() const { return folder_; }

 private:
  std::filesystem::path folder_;
};

}  // namespace aims
