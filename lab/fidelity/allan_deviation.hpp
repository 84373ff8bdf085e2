// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

namespace aims {

/// Allan deviation of a rate at one averaging time.
struct AllanPoint {
  double tau = 0.0;        ///< averaging time [s]
  double deviation = 0.0;  ///< [unit of the series]
};

/// Overlapping Allan deviation (IEEE Std 952-1997, annex C) of a series sampled uniformly at `rate`
/// [Hz], at each of the averaging times [s], rounded to whole samples. White noise of density N
/// gives N / sqrt(tau), a random walk of density K gives K sqrt(tau / 3). Times of which the series
/// does not hold two whole averages are left out.
std::vector<AllanPoint> allan_deviation(std::span<const double> series, double rate,
                                        std::span<const double> averaging_times);

}  // namespace aims
