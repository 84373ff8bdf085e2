// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "recordings/bag/wrapped_source.hpp"

namespace aims {

/// A recording whose record times ran faster than the time of its sensors by `rate`, with record
/// times as if they had not from `start` on. Those before it are of a clock that was not set yet,
/// and stay.
class RatedSource final : public WrappedSource {
 public:
  RatedSource(std::unique_ptr<MessageSource> source, double rate, Time start);

  Result<std::optional<BagMessage>> next() override;

 private:
  Time rated(Time record_time) const;

  double rate_;
  Time start_;
};

}  // namespace aims
