// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <mutex>

#include "bench/run/run.hpp"
#include "bench/studies/suite.hpp"
#include "core/stopwatch.hpp"

namespace aims {

/// Counts what runs on several threads and tells one observer of it.
class ProgressCount {
 public:
  ProgressCount(std::size_t total, const SuiteObserver& observer);

  /// The run `key` has come this far. False once the observer wants no more.
  bool advance(const void* key, const Progress& progress);
  /// The run `key` is done.
  void finish(const void* key);
  /// False once the observer wants no more.
  bool wanted() const;

 private:
  void tell();

  mutable std::mutex mutex_;
  const SuiteObserver& observer_;
  std::size_t total_;
  std::size_t done_ = 0;
  std::map<const void*, double> under_way_;  ///< share of each run that is done
  bool wanted_ = true;
  Stopwatch stopwatch_;
};

}  // namespace aims
