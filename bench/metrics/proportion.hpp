// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "bench/metrics/bootstrap.hpp"

namespace aims {

/// 95 % interval of a probability of which `count` of `trials` independent trials came true (Wilson
/// 1927, without continuity correction); in [0, 1], empty without trials.
Interval wilson_interval(std::size_t count, std::size_t trials);

/// Successes of two on the same sequences, where one alone has one.
struct McNemarTest {
  std::size_t only_first = 0;
  std::size_t only_second = 0;
  double p = 1.0;  ///< two-sided
};

/// McNemar's test in its exact form: where both are equally good, either is as likely to be the one
/// that succeeds alone, so that the smaller count is binomial with probability 1/2 (McNemar 1947;
/// Fagerland, Lydersen and Laake 2013, eq. 4).
McNemarTest mcnemar_test(std::size_t only_first, std::size_t only_second);

/// Probability that this test gives p <= 0.05 on so many sequences with one success when both are
/// equally good; below 0.05, and zero for fewer than six.
double mcnemar_false_alarm(std::size_t discordant);

}  // namespace aims
