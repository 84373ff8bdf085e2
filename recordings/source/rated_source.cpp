// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/source/rated_source.hpp"

#include <cmath>
#include <utility>

namespace aims {

RatedSource::RatedSource(std::unique_ptr<MessageSource> source, double rate, Time start)
    : WrappedSource(std::move(source)), rate_(rate), start_(start) {
  summary_ = source_.summary();
  summary_->end = rated(summary_->end);
}

Time RatedSource::rated(Time record_time) const {
  if (record_time < start_) return record_time;
  return start_ + std::llround(static_cast<double>(record_time - start_) / rate_);
}

Result<std::optional<BagMessage>> RatedSource::next() {
  auto message = read();
  if (!message || !*message) return message;
  (*message)->record_time = rated((*message)->record_time);
  if ((*message)->sampled) (*message)->sampled = rated(*(*message)->sampled);
  return message;
}

}  // namespace aims
