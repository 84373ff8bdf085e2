// SPDX-License-Identifier: BSD-3-Clause
#include "bench/tuning/batch_progress.hpp"

#include <algorithm>

namespace aims {

JobProgress BatchProgress::overall(std::size_t jobs, const JobProgress& batch) {
  const std::size_t found = jobs - std::min(jobs, batch.total);
  const std::size_t total = std::max(expected_, before_ + jobs);
  const double now = batch.fraction * static_cast<double>(batch.total);
  JobProgress all = batch;
  all.done = before_ + found + batch.done;
  all.total = total;
  all.at_most = total > before_ + jobs;
  all.failed = ended_.failed + batch.failed;
  all.sequences = ended_.sequences + batch.sequences;
  fraction_ = std::max(fraction_, (double(before_ + found) + now) / static_cast<double>(total));
  all.fraction = std::min(1.0, fraction_);
  all.elapsed_s = stopwatch_.seconds();
  all.left_s.reset();
  const double work = static_cast<double>(ended_.done) + now;  // without what was found finished
  if (work > 0.0) {
    const double left = static_cast<double>(total - before_ - found) - now;
    all.left_s = all.elapsed_s * std::max(0.0, left) / work;
  }
  return all;
}

void BatchProgress::end(std::size_t jobs, const JobRun& run) {
  before_ += jobs;
  ended_.done += run.done;
  ended_.failed += run.failed;
  ended_.sequences += run.sequences;
}

}  // namespace aims
