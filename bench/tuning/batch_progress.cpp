// SPDX-License-Identifier: BSD-3-Clause
#include "bench/tuning/batch_progress.hpp"

#include <algorithm>

namespace aims {

namespace {

KindOfWork sum_of(const KindOfWork& a, const KindOfWork& b) {
  return {a.total + b.total, a.done + b.done, a.seconds + b.seconds};
}

}  // namespace

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
  all.simulation = sum_of(work_before_[0], batch.simulation);
  all.evaluation = sum_of(work_before_[1], batch.evaluation);
  all.evaluation.total += total - std::min(total, before_ + jobs);  // of batches to come
  all.left_s = time_left(all.simulation, all.evaluation, batch.processes);
  last_ = {batch.simulation, batch.evaluation};
  return all;
}

void BatchProgress::end(std::size_t jobs, const JobRun& run) {
  before_ += jobs;
  for (std::size_t i = 0; i < last_.size(); ++i)
    work_before_[i] = sum_of(work_before_[i], last_[i]);
  last_ = {};
  ended_.done += run.done;
  ended_.failed += run.failed;
  ended_.sequences += run.sequences;
}

}  // namespace aims
